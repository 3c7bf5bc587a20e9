#include "study/paper/paper_study.h"

#include <fmt/format.h>

#include "study/output.h"
#include "study/paper/page.h"

namespace pprt {

void study_paper(const PaperOptions& asked, const std::string& command_line) {
  const PaperOptions options = settled(asked);
  StudyOutput output(options.directory, "The paper's experiments",
                     {{"command", command_line}, {"seed", std::to_string(options.seed)}});
  const PaperResults results =
      run_paper(options, [](const std::string& run) { fmt::print(stderr, "pprt-study: {}\n", run); });
  write_paper(results, options, output);
  output.finish();
}

}  // namespace pprt
