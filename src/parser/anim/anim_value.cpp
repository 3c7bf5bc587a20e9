#include "parser/anim/anim_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/nearest_word.h"

namespace pprt::anim {
namespace {

constexpr std::string_view kNames[] = {"sin", "cos", "tan", "sqrt", "abs", "min", "max", "pi"};

// Returns the sine of an angle in degrees plus `quarters` quarter turns. Exact at multiples of a quarter
// turn.
double sine_of_degrees(double degrees, int quarters) {
  int quadrant = 0;
  const double rest = std::remquo(degrees, 90, &quadrant) * (std::numbers::pi / 180);  // within +-45 degrees
  switch ((quadrant + quarters) & 3) {
    case 0:
      return std::sin(rest);
    case 1:
      return std::cos(rest);
    case 2:
      return -std::sin(rest);
    default:
      return -std::cos(rest);
  }
}

const char* kind_of(const Value& value) {
  return value.size == 1 ? "a number" : "a vector";
}

Value problem(const char* place, std::string message, Problems& problems) {
  problems.error(place, std::move(message));
  return {.place = place};
}

// Refuses numbers beyond the limit, so that nothing computed from them overflows.
Value checked(Value value, const char* place, Problems& problems) {
  for (const double c : value.c) {
    if (!(std::abs(c) <= kLargestNumber)) return problem(place, "the result is too large", problems);
  }
  return value;
}

const char* verb(Operation operation) {
  switch (operation) {
    case Operation::kAdd:
      return "add";
    case Operation::kSubtract:
      return "subtract";
    case Operation::kMultiply:
      return "multiply";
    case Operation::kDivide:
      return "divide";
    case Operation::kPower:
      return "raise to a power";
  }
  return "";
}

bool fits(Operation operation, const Value& a, const Value& b) {
  switch (operation) {
    case Operation::kAdd:
    case Operation::kSubtract:
      return a.size == b.size;
    case Operation::kMultiply:
      return a.size == 1 || b.size == 1;
    case Operation::kDivide:
      return b.size == 1;
    case Operation::kPower:
      return a.size == 1 && b.size == 1;
  }
  return false;
}

double applied(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kPower:
      return std::pow(a, b);
  }
  return 0;
}

}  // namespace

Value calculate(Operation operation, const Value& a, const Value& b, const char* place, Problems& problems) {
  if (!a.known() || !b.known()) return {.place = a.place};
  if (!fits(operation, a, b)) {
    const bool vectors = a.size > 1 && b.size > 1 && a.size != b.size;
    return problem(
        place,
        vectors ? fmt::format("cannot {} vectors of {} and {} components", verb(operation), a.size, b.size)
                : fmt::format("cannot {} {} and {}", verb(operation), kind_of(a), kind_of(b)),
        problems);
  }
  if (operation == Operation::kDivide && b.c[0] == 0) return problem(place, "division by zero", problems);
  if (operation == Operation::kPower) {
    if (a.c[0] == 0 && b.c[0] < 0) return problem(place, "division by zero", problems);
    if (a.c[0] < 0 && b.c[0] != std::trunc(b.c[0])) {
      return problem(place, "a negative number has no power that is not whole", problems);
    }
  }
  Value result;
  result.size = std::max(a.size, b.size);
  result.place = a.place;
  const auto component = [](const Value& value, int i) {
    return value.c[value.size == 1 ? 0 : static_cast<std::size_t>(i)];
  };
  for (int i = 0; i < result.size; ++i) {
    result.c[static_cast<std::size_t>(i)] = applied(operation, component(a, i), component(b, i));
  }
  return checked(result, place, problems);
}

Value negated(const Value& a) {
  Value result = a;
  for (double& c : result.c) c = -c;
  return result;
}

Value call_function(std::string_view name, std::span<const Value> arguments, const char* place,
                    Problems& problems) {
  if (name == "pi") return problem(place, "'pi' is a number, not a function", problems);
  if (!is_function(name)) {
    return problem(place,
                   fmt::format("unknown function {}{}", quoted(name), did_you_mean(name, built_in_names())),
                   problems);
  }
  for (const Value& argument : arguments) {
    if (!argument.known()) return {.place = place};
    if (argument.size != 1)
      return problem(argument.place, fmt::format("'{}' is of numbers, not vectors", name), problems);
  }
  Value result{1, {}, place};
  double& r = result.c[0];
  r = arguments[0].c[0];
  if (name == "min" || name == "max") {
    for (const Value& argument : arguments) {
      r = name == "min" ? std::min(r, argument.c[0]) : std::max(r, argument.c[0]);
    }
    return result;
  }
  if (arguments.size() != 1) {
    return problem(place, fmt::format("'{}' is of one number, not of {}", name, arguments.size()), problems);
  }
  if (name == "sqrt" && r < 0) return problem(place, "a negative number has no square root", problems);
  if (name == "tan" && sine_of_degrees(r, 1) == 0)
    return problem(place, "the tangent is infinite here", problems);
  if (name == "sin")
    r = sine_of_degrees(r, 0);
  else if (name == "cos")
    r = sine_of_degrees(r, 1);
  else if (name == "tan")
    r = sine_of_degrees(r, 0) / sine_of_degrees(r, 1);
  else if (name == "sqrt")
    r = std::sqrt(r);
  else
    r = std::abs(r);
  return result;
}

bool is_function(std::string_view name) {
  return name != "pi" && std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

std::span<const std::string_view> built_in_names() {
  return kNames;
}

}  // namespace pprt::anim
