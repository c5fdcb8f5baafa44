// flinch reproduce: figures of the papers, and ours.
#include <algorithm>
#include <csignal>

#include "apps/flinch/command_line.h"
#include "apps/flinch/own_command.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "apps/flinch/shipped_files.h"
#include "experiments/report/run_folder.h"
#include "experiments/reproduction/paper_file.h"
#include "experiments/reproduction/reproduction.h"
#include "systems/foundation/result_file.h"

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

PaperFigures wanted_figures(const ReproduceOptions& options) {
  PaperFigures all = read_paper_file(options.file.empty() ? or_shipped("papers", "papers")
                                                          : or_shipped(options.file, "papers"));
  if (options.only.empty()) return all;
  PaperFigures wanted;
  const auto add = [](auto& list, auto each) {
    const auto same = [&each](const auto& other) { return other.id == each.id; };
    if (std::none_of(list.begin(), list.end(), same)) list.push_back(std::move(each));
  };
  for (const std::string& only : options.only) {
    const PaperFigures called = figures_called(all, only);
    for (const PaperFigure& figure : called.figures) add(wanted.figures, figure);
    for (const PaperPicture& picture : called.pictures) add(wanted.pictures, picture);
  }
  return wanted;
}

}  // namespace

ExitStatus reproduce(const ReproduceOptions& options) {
  const PaperFigures wanted = wanted_figures(options);
  const RunFolder folder = make_run_folder(options.out.empty() ? default_folder("papers") : options.out);
  std::signal(SIGINT, [](int) { interrupted = 1; });
  const Reproduction reproduced = [&] {
    Progress progress("reproducing the papers", options.common.quiet || options.common.json);
    return reproduce(wanted, {.folder = folder.path,
                              .threads = options.threads.value_or(0),
                              .progress =
                                  [&](double share) {
                                    progress.show(share);
                                    return interrupted == 0;
                                  },
                              .run_command = run_own_command});
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
