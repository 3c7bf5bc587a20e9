#include "cli/exit.h"

#include <fmt/core.h>

#include <exception>
#include <new>

#include "base/diagnostics.h"
#include "base/printable.h"
#include "cli/launch.h"

namespace pprt {

int run_guarded(std::string_view program, const std::function<int()>& body) {
  try {
    return body();
  } catch (const InputError& e) {
    if (launcher_rank() > 0) return kExitDone;
    fmt::print(stderr, "{}\n", printable_lines(e.what()));
    return kExitInput;
  } catch (const UsageError& e) {
    if (launcher_rank() > 0) return kExitDone;
    fmt::print(stderr, "{0}: error: {1}\ntry '{0} --help'\n", program, printable_lines(e.what()));
    return kExitUsage;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "{}: error: out of memory\n", program);
    return kExitFailure;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: error: {}\n", program, printable_lines(e.what()));
    return kExitFailure;
  }
}

}  // namespace pprt
