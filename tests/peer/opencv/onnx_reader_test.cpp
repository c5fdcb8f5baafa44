// Another program's reader of ONNX, OpenCV's, finds in our files the networks that we mean.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/dnn.hpp>

#include "learning/onnx_file.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

ClassifierModel random_model(const std::vector<int>& widths, Activation activation, std::uint64_t seed) {
  RandomGenerator random(seed);
  ClassifierModel model;
  const auto fill = [&random](auto& numbers) {
    for (double& number : numbers.reshaped())
      number = static_cast<double>(static_cast<float>(random.normal()));
  };
  model.network.mean.resize(widths.front());
  fill(model.network.mean);
  model.network.scale.resize(widths.front());
  fill(model.network.scale);
  model.network.scale = model.network.scale.cwiseAbs().array() + 0.5;
  for (std::size_t i = 1; i < widths.size(); ++i) {
    NetworkLayer& layer = model.network.layers.emplace_back();
    layer.weights.resize(widths[i], widths[i - 1]);
    layer.bias.resize(widths[i]);
    fill(layer.weights);
    fill(layer.bias);
    layer.activation = i + 1 == widths.size() ? Activation::none : activation;
  }
  model.network.result = NetworkResult::softmax_of_outputs;
  for (int i = 0; i < widths.front(); ++i) {
    model.features.push_back("feature" + std::to_string(i));
    model.units.emplace_back("1");
  }
  for (int i = 0; i < widths.back(); ++i) model.classes.push_back("class" + std::to_string(i));
  return model;
}

TEST(OpenCv, ComputesWhatWeComputeWithTheNetworksThatWeWrite) {
  for (const Activation activation : {Activation::tanh, Activation::relu, Activation::sigmoid}) {
    const ClassifierModel model = random_model({12, 30, 30, 7}, activation, 1);
    const std::string bytes = onnx_bytes(model);
    cv::dnn::Net theirs = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    const NeuralNetwork ours(model.network);
    RandomGenerator random(2);
    for (int trial = 0; trial < 50; ++trial) {
      NeuralNetwork::Values inputs(12, 1), outputs;
      cv::Mat row(1, 12, CV_32F);
      for (int i = 0; i < 12; ++i) {
        row.at<float>(0, i) = static_cast<float>(2.0 * random.normal());
        inputs(i, 0) = static_cast<double>(row.at<float>(0, i));
      }
      ASSERT_TRUE(ours.evaluate(inputs, outputs));
      theirs.setInput(row);
      const cv::Mat answer = theirs.forward();
      ASSERT_EQ(answer.total(), 7U);
      for (int i = 0; i < 7; ++i)
        EXPECT_NEAR(static_cast<double>(answer.at<float>(0, i)), outputs(i, 0), 2e-5);
    }
  }
}

}  // namespace
}  // namespace flinch
