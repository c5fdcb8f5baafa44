#include "experiments/reproduction/paper_figures.h"

#include <algorithm>
#include <iterator>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

PaperFigures figures_called(const PaperFigures& all, const std::string& only) {
  PaperFigures called;
  std::vector<std::string> ids;
  const auto is_called = [&](const auto& each) {
    ids.push_back(each.id);
    return ("." + each.id + ".").find("." + only + ".") != std::string::npos;
  };
  std::copy_if(all.figures.begin(), all.figures.end(), std::back_inserter(called.figures), is_called);
  std::copy_if(all.pictures.begin(), all.pictures.end(), std::back_inserter(called.pictures), is_called);
  if (called.figures.empty() && called.pictures.empty())
    throw SetupError("no figure is called '" + only + "'" + did_you_mean(only, ids));
  return called;
}

}  // namespace flinch
