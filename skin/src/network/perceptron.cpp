// SPDX-License-Identifier: Apache-2.0
#include "network/perceptron.h"

#include "metamer/spectral/input_error.h"

namespace metamer::skin {
namespace {

constexpr const char* kRemedy = "is no network of this release; use its data folder";

nlohmann::json member(const nlohmann::json& parent, const char* key) {
  return parent.is_object() ? parent.value(key, nlohmann::json()) : nlohmann::json();
}

}  // namespace

Eigen::VectorXd numbersOf(const nlohmann::json& list, Eigen::Index count, const std::string& where) {
  if (!list.is_array() || list.empty() || (count > 0 && static_cast<Eigen::Index>(list.size()) != count)) {
    throw spectral::InputError(where, "weights", "", kRemedy);
  }
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(list.size()));
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    const nlohmann::json& item = list[static_cast<std::size_t>(i)];
    if (!item.is_number()) {
      throw spectral::InputError(where, "weights", "", kRemedy);
    }
    numbers[i] = item.get<double>();
  }
  return numbers;
}

Perceptron::Perceptron(const nlohmann::json& layers, Eigen::Index inputs, Eigen::Index outputs,
                       const std::string& where) {
  if (!layers.is_array() || layers.empty()) {
    throw spectral::InputError(where, "layers", "", kRemedy);
  }
  Eigen::Index width = inputs;
  for (const nlohmann::json& given : layers) {
    Layer layer;
    layer.biases = numbersOf(member(given, "biases"), 0, where);
    const nlohmann::json rows = member(given, "weights");
    if (!rows.is_array() || static_cast<Eigen::Index>(rows.size()) != layer.biases.size()) {
      throw spectral::InputError(where, "weights", "", kRemedy);
    }
    layer.weights.resize(layer.biases.size(), width);
    for (Eigen::Index row = 0; row < layer.weights.rows(); ++row) {
      layer.weights.row(row) = numbersOf(rows[static_cast<std::size_t>(row)], width, where).transpose();
    }
    width = layer.biases.size();
    m_layers.push_back(std::move(layer));
  }
  if (width != outputs) {
    throw spectral::InputError(where, "layers", std::to_string(width), kRemedy);
  }
}

Eigen::VectorXd Perceptron::operator()(const Eigen::VectorXd& input) const {
  Eigen::VectorXd values = input;
  for (const Layer& layer : m_layers) {
    values = (layer.weights * values + layer.biases).eval();
    if (&layer != &m_layers.back()) {
      values = values.array().tanh();
    }
  }
  return values;
}

}  // namespace metamer::skin
