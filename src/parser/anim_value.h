// The values of a script's expressions, and arithmetic on them that reports what cannot be done.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "parser/anim_problems.h"

namespace pprt::anim {

// A number (size 1) or a vector (2, 3). Size 0: a problem that has been reported; what is made from it is
// size 0 again and no further problem.
struct Value {
  int size = 0;
  std::array<double, 3> c{0, 0, 0};  // unused components are 0
  const char* place = nullptr;       // where it begins in the text, of unknown ones too

  bool known() const { return size > 0; }
};

enum class Operation { kAdd, kSubtract, kMultiply, kDivide, kPower };

// `place` is the operator's. Vectors are added and subtracted among their like, and multiplied and divided by
// numbers. The result begins where `a` does.
Value calculate(Operation operation, const Value& a, const Value& b, const char* place, Problems& problems);

Value negated(const Value& a);

// sin, cos, tan (of degrees), sqrt, abs (one number), min, max (one or more). `place` is the name's.
Value call_function(std::string_view name, std::span<const Value> arguments, const char* place,
                    Problems& problems);

// Whether `name` is a function; of one argument, or of any number of them.
bool is_function(std::string_view name);

// All names that stand for something without being declared.
std::span<const std::string_view> built_in_names();

}  // namespace pprt::anim
