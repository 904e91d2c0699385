// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace metamer::skin {

/// Layers of weights with tanh between them.
class Perceptron {
 public:
  /// @param layers  a list of {"weights": rows, "biases": list}
  /// @throws spectral::InputError where sizes do not fit
  Perceptron(const nlohmann::json& layers, Eigen::Index inputs, Eigen::Index outputs, const std::string& where);

  Eigen::VectorXd operator()(const Eigen::VectorXd& input) const;

 private:
  struct Layer {
    Eigen::MatrixXd weights;
    Eigen::VectorXd biases;
  };
  std::vector<Layer> m_layers;
};

/// As many finite numbers as wanted (any where that is 0). @throws spectral::InputError
Eigen::VectorXd numbersOf(const nlohmann::json& list, Eigen::Index count, const std::string& where);

}  // namespace metamer::skin
