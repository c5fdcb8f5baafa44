#include "tests/campaign/classification/documented_figures.h"

#include <cmath>
#include <fstream>
#include <regex>

#include "experiments/campaign/exact_bounds.h"

namespace flinch::test {
namespace {

constexpr double confidence = 0.999;

ShareBounds bounds_at(double events, double trials, double of_each) {
  const auto all = static_cast<std::size_t>(std::lround(trials));
  const auto seen = static_cast<std::size_t>(std::lround(events));
  return {1.0 - clopper_pearson_upper(all - seen, all, of_each), clopper_pearson_upper(seen, all, of_each)};
}

}  // namespace

std::vector<double> documented_row(const std::string& start) {
  std::ifstream document(FLINCH_SOURCE_DIR "/docs/theory.md");
  std::vector<double> numbers;
  int rows = 0;
  for (std::string line; std::getline(document, line);) {
    if (!line.starts_with("| " + start)) continue;
    ++rows;
    const std::string cells = line.substr(line.find('|', 1));
    const std::regex number("[0-9]+(\\.[0-9]+)?");
    for (std::sregex_iterator found(cells.begin(), cells.end(), number), end; found != end; ++found)
      numbers.push_back(std::stod(found->str()));
  }
  return rows == 1 ? numbers : std::vector<double>();
}

bool ShareBounds::allow(double percent) const {
  return least <= 0.01 * percent + 0.0005 && 0.01 * percent - 0.0005 <= most;
}

ShareBounds bounds_of_share(double events, double trials) { return bounds_at(events, trials, confidence); }

ShareBounds bounds_of_mean(const Confusion& confusion) {
  const Eigen::VectorXd trials = confusion.counts.rowwise().sum();
  const auto classes = static_cast<double>((trials.array() > 0.0).count());
  ShareBounds mean{0.0, 0.0};
  for (Eigen::Index i = 0; i < trials.size(); ++i) {
    if (trials[i] == 0.0) continue;
    const ShareBounds of_class =
        bounds_at(confusion.counts(i, i), trials[i], 1.0 - (1.0 - confidence) / classes);
    mean.least += of_class.least / classes;
    mean.most += of_class.most / classes;
  }
  return mean;
}

}  // namespace flinch::test
