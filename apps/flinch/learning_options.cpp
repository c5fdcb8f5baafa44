// The command line of flinch dataset, flinch train and flinch evaluate.
#include <limits>

#include "apps/flinch/verbs.h"

namespace flinch {
namespace {

void add_dataset_verb(CLI::App& app, Verbs& verbs) {
  DatasetOptions& options = verbs.dataset;
  CLI::App& verb = verbs.add(app, "dataset", "Make labelled contacts for classifiers, simulated or recorded",
                             "flinch dataset apps/models/bodies.yaml --runs 2000 --seed 2 --out out/test.h5",
                             options, &dataset);
  verb.add_option("spec", options.spec, "Specification of the data (YAML)")
      ->required()
      ->type_name("SPEC.yaml");
  verb.add_option("--runs", options.runs, "Simulated runs, all together [the file's]")
      ->check(between(1, 10'000'000))
      ->type_name("N");
  verb.add_option("--seed", options.seed, "Seed of all that is drawn [the file's]")
      ->check(problem_with_seed)
      ->type_name("N");
  verb.add_option("-o,--out", options.out, "The data set [out/NAME.h5]")->type_name("DATA.h5");
  add_threads(verb, options.threads, "Runs at once [one a processor]");
  verb.add_flag("--fresh", options.fresh, "Begin anew, whatever an earlier call has left");
}

void add_train_verb(CLI::App& app, Verbs& verbs) {
  TrainOptions& options = verbs.train;
  CLI::App& verb = verbs.add(app, "train", "Train a classifier with a data set: an ONNX file",
                             "flinch train out/bodies.h5 -o out/bodies.onnx", options, &train);
  verb.add_option("data", options.data, "Data set (HDF5) of flinch dataset")
      ->required()
      ->type_name("DATA.h5");
  verb.add_option("-o,--out", options.out, "The model")->required()->type_name("MODEL.onnx");
  verb.add_option(
          "--question", options.question,
          "What it tells: touched (which body or gap), or as in the papers body, clamping, chain [touched]")
      ->type_name("NAME");
  CLI::Option* hidden = verb.add_option("--hidden", options.hidden,
                                        "Widths of the tanh layers, such as 30,30 [of the question]")
                            ->delimiter(',')
                            ->allow_extra_args(false)
                            ->check(between(1, 1000))
                            ->type_name("N,N");
  CLI::Option* l2 = verb.add_option("--l2", options.l2,
                                    "Weight of the squared weights; of several the best in the "
                                    "cross-validation [1e-5; for the papers' questions 1e-4,1e-3,1e-2]")
                        ->delimiter(',')
                        ->allow_extra_args(false)
                        ->check(within(0.0, 1e6))
                        ->type_name("X,X");
  verb.add_option(
          "--least-scale", options.least_scale,
          "Least number that inputs are divided by; large: what hardly varied in the data counts little [0]")
      ->check(within(0.0, 1e6))
      ->type_name("X");
  verb.add_option("--learning-rate", options.learning_rate, "Of Adam, at first [of the question]")
      ->check(within(1e-12, 1e3))
      ->type_name("X");
  verb.add_option("--epochs", options.epochs,
                  "Passes through the data; of several the best in the cross-validation [40; for the papers' "
                  "questions 10,20,40, with --grid 40]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(between(1, 1'000'000))
      ->type_name("N,N");
  verb.add_flag("--grid", options.grid, "Search the papers' grid of layers, widths and L2 (80 networks)")
      ->excludes(hidden)
      ->excludes(l2);
  verb.add_option("--folds", options.folds, "Of the cross-validation [5]")
      ->check(between(2, 100))
      ->type_name("N");
  verb.add_option("--folds-by", options.folds_by,
                  "What no two folds share: run, or configuration, of which there must be several [run]")
      ->type_name("NAME");
  verb.add_option("--configurations", options.configurations, "Only samples of these, such as 0,1 [all]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(between(0, std::numeric_limits<int>::max()))
      ->type_name("N,N");
  verb.add_option("--seed", options.seed, "Of weights and folds [1]")
      ->check(problem_with_seed)
      ->type_name("N");
  add_threads(verb, options.threads, "Networks at once [one a processor]");
}

void add_evaluate_verb(CLI::App& app, Verbs& verbs) {
  EvaluateOptions& options = verbs.evaluate;
  CLI::App& verb =
      verbs.add(app, "evaluate", "Show how well a classifier tells what was touched: tables and a page",
                "flinch evaluate apps/models/bodies.onnx out/test.h5", options, &evaluate);
  verb.add_option("model", options.model, "Model (ONNX) of flinch train, or of another program")
      ->required()
      ->type_name("MODEL.onnx");
  verb.add_option("data", options.data, "Data set (HDF5) of flinch dataset")
      ->required()
      ->type_name("DATA.h5");
  verb.add_option(
          "--at", options.at,
          "Which samples: early, detected, later (10 ms after that), all [later, or what the data say]")
      ->type_name("MOMENT");
  verb.add_option("--configurations", options.configurations, "Only samples of these, such as 1,2 [all]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(between(0, std::numeric_limits<int>::max()))
      ->type_name("N,N");
  verb.add_option("-o,--out", options.out, "The page [DATA_MODEL.html beside the data]")
      ->type_name("PAGE.html");
  add_threads(verb, options.threads, "At once [one a processor]");
}

}  // namespace

void add_learning_verbs(CLI::App& app, Verbs& verbs) {
  add_dataset_verb(app, verbs);
  add_train_verb(app, verbs);
  add_evaluate_verb(app, verbs);
}

}  // namespace flinch
