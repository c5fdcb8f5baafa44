// flinch reproduce: figures of the papers, and ours.
#include <algorithm>
#include <csignal>

#include "apps/flinch/command_line.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/shipped_files.h"
#include "experiments/report/run_folder.h"
#include "experiments/reproduction/reproduction.h"
#include "systems/foundation/result_file.h"

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

std::vector<PaperFigure> wanted_figures(const ReproduceOptions& options) {
  const auto all = read_paper_figures(options.file.empty() ? or_shipped("papers", "papers")
                                                           : or_shipped(options.file, "papers"));
  std::vector<PaperFigure> wanted;
  for (const std::string& only : options.only) {
    for (PaperFigure& figure : figures_called(all, only)) {
      const auto same = [&figure](const PaperFigure& other) { return other.id == figure.id; };
      if (std::none_of(wanted.begin(), wanted.end(), same)) wanted.push_back(std::move(figure));
    }
  }
  return options.only.empty() ? all : wanted;
}

}  // namespace

ExitStatus reproduce(const ReproduceOptions& options) {
  const std::vector<PaperFigure> figures = wanted_figures(options);
  const RunFolder folder = make_run_folder(options.out.empty() ? default_folder("papers") : options.out);
  std::signal(SIGINT, [](int) { interrupted = 1; });
  const std::vector<ReproducedFigure> reproduced = [&] {
    Progress progress("reproducing the papers", options.common.quiet || options.common.json);
    return reproduce(figures, folder.path, options.threads.value_or(0), [&](double share) {
      progress.show(share);
      return interrupted == 0;
    });
  }();
  std::signal(SIGINT, SIG_DFL);
  print_result("{}",
               options.common.json ? reproduction_json(reproduced) + "\n" : reproduction_table(reproduced));
  flush_results();  // before what stderr says, where both go into one file
  const std::filesystem::path page = folder.path / "papers.html";
  write_result(page, reproduction_page(reproduced, options.common.command_line));
  if (!options.common.quiet) print_message("report:    {}\n", page.string());
  return ExitStatus::done;
}

}  // namespace flinch
