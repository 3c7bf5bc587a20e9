#include "app/study_paper.h"

#include <fmt/format.h>

#include "app/study_output.h"
#include "app/study_paper_page.h"

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
