// How well the shipped model tells contacts that nobody has learned from, as the table of docs/theory.md
// says. FLINCH_CLASSIFIED in the environment says of how many runs; 4000 are those of that table.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "experiments/dataset/data_spec.h"
#include "experiments/dataset/make_data_set.h"
#include "learning/model_questions.h"
#include "learning/onnx_file.h"
#include "tests/campaign/classification/documented_figures.h"
#include "tests/campaign/classification/named_moments.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr int all_runs = 4000;

/// The columns of the table, in its order; shares in percent.
struct Row {
  double body, collision, clamping, leg, calibration, rejected, wrong, wrong_at_tenth;
};

std::optional<Row> documented(const std::string& moment) {
  const std::vector<double> numbers = test::documented_row(moment + ":");
  if (numbers.size() != 8) return std::nullopt;
  return Row{numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6], numbers[7]};
}

/// What was answered at a moment, and what is counted of it.
class Seen {
 public:
  Seen(const ClassifierModel& model, const DataSet& data, const NamedMoment& moment)
      : features_(features_for(model, data)), classes_(classes_of(*data.robot)) {
    const Questions questions = questions_of(data, features_, {moment.which, {}}, false);
    answers_ = answers_of(NeuralNetwork(model.network), questions, data);
    disbelieve_small(answers_, data, model.least_wrench);
    evaluation_ = evaluate(answers_, features_, model.accepted_from, moment.name);
  }

  const Evaluation& evaluation() const { return evaluation_; }

  /// Only bodies are chosen from, or only legs that clamp.
  Confusion bodies() const { return among(0, classes_.bodies()); }
  Confusion legs() const { return among(classes_.bodies(), classes_.count()); }

  void print() const {
    const Evaluation& e = evaluation_;
    std::printf("| %s | %.1f %% | %.1f %% | %.1f %% | %.1f %% | %.3f | %.1f %%, %.2f %% | %.2f %% |\n",
                e.moment.c_str(), 100.0 * e.body.value_or(0.0), 100.0 * e.collision.value_or(0.0),
                100.0 * e.clamping.value_or(0.0), 100.0 * e.chain.value_or(0.0), e.calibration_error,
                100.0 * e.accepted.rejected, 100.0 * e.accepted.wrong_of_accepted,
                100.0 * e.at_tenth.wrong_of_accepted);
  }

  void expect(const Row& stated) const {
    const Evaluation& e = evaluation_;
    const auto samples = static_cast<double>(e.samples);
    const double collisions = bodies().counts.sum(), clampings = legs().counts.sum();
    expect_share(stated.body, test::bounds_of_mean(bodies()), "body");
    expect_share(stated.leg, test::bounds_of_mean(legs()), "leg");
    expect_share(stated.collision, test::bounds_of_share(*e.collision * collisions, collisions), "collision");
    expect_share(stated.clamping, test::bounds_of_share(*e.clamping * clampings, clampings), "clamping");
    expect_share(stated.rejected, test::bounds_of_share(e.accepted.rejected * samples, samples), "rejected");
    expect_share(stated.wrong, bounds_of_wrong(e.accepted), "wrong");
    expect_share(stated.wrong_at_tenth, bounds_of_wrong(e.at_tenth), "wrong at a tenth");
  }

 private:
  Confusion among(int first, int end) const {
    std::vector<std::string> names;
    std::vector<int> of(static_cast<std::size_t>(classes_.count()), -1);
    for (int i = first; i < end; ++i) {
      of[static_cast<std::size_t>(i)] = i - first;
      names.push_back(classes_.name(i));
    }
    return confusion_of(answers_, names, of);
  }
  test::ShareBounds bounds_of_wrong(const RejectPoint& point) const {
    const double accepted = (1.0 - point.rejected) * static_cast<double>(evaluation_.samples);
    return test::bounds_of_share(point.wrong_of_accepted * accepted, accepted);
  }
  void expect_share(double percent, const test::ShareBounds& bounds, const char* what) const {
    EXPECT_TRUE(bounds.allow(percent))
        << what << " " << evaluation_.moment << ": " << percent << " % are stated, " << 100.0 * bounds.least
        << " to " << 100.0 * bounds.most << " % counted";
  }

  FeatureSet features_;
  ContactClasses classes_;
  std::vector<Answered> answers_;
  Evaluation evaluation_;
};

TEST(ShippedModel, TellsContactsAsWellAsIsStated) {
  const int runs = test::wanted("FLINCH_CLASSIFIED", 120);
  const DataSpec spec = read_data_spec(FLINCH_SOURCE_DIR "/apps/models/bodies.yaml",
                                       {.runs = static_cast<std::size_t>(runs), .seed = 2});
  const test::TemporaryFolder folder;
  const DataSet data = make_data_set(spec, folder / "data.h5");
  const ClassifierModel model = read_onnx(FLINCH_SOURCE_DIR "/apps/models/bodies.onnx");
  for (const NamedMoment& moment : named_moments) {
    const auto stated = documented(moment.name);
    ASSERT_TRUE(stated) << "docs/theory.md has no such row: " << moment.name;
    const Seen seen(model, data, moment);
    seen.print();
    seen.expect(*stated);
    if (runs >= all_runs) {  // the same contacts: what is counted in few is far off by chance
      EXPECT_NEAR(seen.evaluation().calibration_error, stated->calibration, 0.005);
    }
  }
}

}  // namespace
}  // namespace flinch
