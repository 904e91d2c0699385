// SPDX-License-Identifier: Apache-2.0
#include "storage/moments.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace metamer::spectral {
namespace {

using Complex = std::complex<double>;
using ComplexVector = Eigen::VectorXcd;
using Eigen::Index;
using std::numbers::pi;

/// The first column of the inverse of the Hermitian Toeplitz matrix of moments. Empty where that is not positive.
ComplexVector firstOfInverse(const ComplexVector& moments) {
  const Index size = moments.size();
  Eigen::MatrixXcd toeplitz(size, size);
  for (Index row = 0; row < size; ++row) {
    for (Index column = 0; column < size; ++column) {
      toeplitz(row, column) = row >= column ? moments[row - column] : std::conj(moments[column - row]);
    }
  }
  const Eigen::LLT<Eigen::MatrixXcd> factors(toeplitz);
  if (factors.info() != Eigen::Success) {
    return {};
  }
  const ComplexVector first = factors.solve(ComplexVector(ComplexVector::Unit(size, 0)));
  return first.allFinite() ? first : ComplexVector();
}

Complex polynomial(const ComplexVector& coefficients, const Complex& z) {
  Complex value = 0;
  for (Index k = coefficients.size(); k-- > 0;) {
    value = value * z + coefficients[k];
  }
  return value;
}

Eigen::VectorXd nothing(Index size) {
  return Eigen::VectorXd::Constant(size, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

Eigen::VectorXd trigonometricMoments(const Eigen::VectorXd& phases, const Eigen::VectorXd& signal, int count) {
  Eigen::VectorXd moments = Eigen::VectorXd::Zero(count);
  for (Index k = 0; k + 1 < phases.size(); ++k) {
    const double step = phases[k + 1] - phases[k];
    moments[0] += 0.5 * (signal[k] + signal[k + 1]) * step / pi;
    const double slope = (signal[k + 1] - signal[k]) / step;
    for (int j = 1; j < count; ++j) {
      // By parts: what the sines add is 0 at both ends.
      moments[j] += slope * (std::cos(j * phases[k + 1]) - std::cos(j * phases[k])) / (pi * j * j);
    }
  }
  return moments;
}

Eigen::VectorXd boundedSignal(const Eigen::VectorXd& moments, const Eigen::VectorXd& phases) {
  // exp(i pi (G - 1/2)), G the function on the disc whose real part is the signal on its rim, has a real part that is
  // positive: a positive signal of its own, whose moments follow from the bounded one's (equation 9).
  const Index size = moments.size();
  const Complex i(0, 1);
  ComplexVector exponential(size);
  exponential[0] = std::exp(i * pi * (moments[0] - 0.5));
  for (Index l = 1; l < size; ++l) {
    Complex sum = 0;
    for (Index j = 0; j < l; ++j) {
      sum += static_cast<double>(l - j) * moments[l - j] * exponential[j];
    }
    exponential[l] = 2.0 * pi * i / static_cast<double>(l) * sum;
  }
  ComplexVector positive = exponential;
  positive[0] = 2 * exponential[0].real();
  const ComplexVector below = firstOfInverse(positive);
  if (below.size() == 0) {
    return nothing(phases.size());
  }
  // Of the maximum entropy's function: numerator over `below`, of which the argument is the signal.
  ComplexVector above = ComplexVector::Zero(size);
  for (Index l = 0; l < size; ++l) {
    for (Index j = 0; j <= l; ++j) {
      above[l] += exponential[j] * below[l - j];
    }
  }
  Eigen::VectorXd signal(phases.size());
  for (Index k = 0; k < phases.size(); ++k) {
    const Complex z = std::polar(1.0, phases[k]);
    signal[k] = std::arg(polynomial(above, z) * std::conj(polynomial(below, z))) / pi + 0.5;
  }
  return signal.cwiseMax(0.0).cwiseMin(1.0);
}

Eigen::VectorXd positiveSignal(const Eigen::VectorXd& moments, const Eigen::VectorXd& phases) {
  const ComplexVector below = firstOfInverse(moments.cast<Complex>());
  if (below.size() == 0) {
    return nothing(phases.size());
  }
  // The mean about each phase: peaks are narrower than steps.
  constexpr int kWithin = 32;
  const auto mean = [&](double from, double to) {
    double sum = 0;
    for (int k = 0; k < kWithin; ++k) {
      const double phase = from + (to - from) * (k + 0.5) / kWithin;
      sum += below[0].real() / std::norm(polynomial(below, std::polar(1.0, phase)));
    }
    return sum / kWithin;
  };
  const Index last = phases.size() - 1;
  Eigen::VectorXd signal(phases.size());
  for (Index k = 0; k <= last; ++k) {
    const double from = k > 0 ? 0.5 * (phases[k - 1] + phases[k]) : phases[0];
    const double to = k < last ? 0.5 * (phases[k] + phases[k + 1]) : phases[last];
    signal[k] = mean(from, to);
  }
  return signal;
}

}  // namespace metamer::spectral
