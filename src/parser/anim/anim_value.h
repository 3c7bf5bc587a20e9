// Values of expressions in animation scripts, and their arithmetic.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "parser/anim/anim_problems.h"

namespace pprt::anim {

// A number (size 1) or a vector (size 2 or 3). Size 0 marks a value whose problem has been reported: results
// made from it have size 0 too, and nothing more is reported.
struct Value {
  int size = 0;
  std::array<double, 3> c{0, 0, 0};  // unused components are 0
  const char* place = nullptr;       // where the expression begins in the text, also when size is 0

  bool known() const { return size > 0; }
};

enum class Operation { kAdd, kSubtract, kMultiply, kDivide, kPower };

// Applies a binary operator; `place` is the operator's. Vectors of one size add and subtract; a number
// multiplies a vector and divides it. The result begins where `a` does. Reports what cannot be computed and
// returns size 0.
Value calculate(Operation operation, const Value& a, const Value& b, const char* place, Problems& problems);

// Returns -a, at the same place.
Value negated(const Value& a);

// Calls sin, cos, tan (of degrees), sqrt, abs (one number each), min or max (one or more). `place` is the
// name's. Reports what cannot be computed and returns size 0.
Value call_function(std::string_view name, std::span<const Value> arguments, const char* place,
                    Problems& problems);

// Returns whether `name` is a function.
bool is_function(std::string_view name);

// Returns all names that have a meaning without being declared.
std::span<const std::string_view> built_in_names();

}  // namespace pprt::anim
