#pragma once

#include <filesystem>
#include <string>

#include "learning/classifier_model.h"

namespace flinch {

/// The model as ONNX (IR 7, opset 13): Sub, Div, Gemm and an activation for each layer, Softmax. Classes,
/// features, units and provenance are metadata, so any program that reads ONNX can ask the network and show
/// what it means. Throws SetupError for a model that is not whole, or a file that cannot be written.
std::string onnx_bytes(const ClassifierModel& model);
void write_onnx(const ClassifierModel& model, const std::filesystem::path& file);

/// Reads a classifier, written by us or exported by another program: one chain, from one input to one output,
/// of Sub and Div by constants, Gemm, MatMul and Add, Tanh, Relu, Sigmoid, Softmax at the end, and Identity
/// and Cast anywhere, in float or double. Whatever else is in the file, or what is broken, is told by its
/// name. The file may be hostile. Throws SetupError with all that is wrong, each after the name of the file.
ClassifierModel read_onnx(const std::filesystem::path& file);
/// The same for bytes that came from `file`.
ClassifierModel parse_onnx(const std::string& bytes, const std::string& file);

}  // namespace flinch
