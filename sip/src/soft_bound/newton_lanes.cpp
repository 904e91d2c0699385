// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set by Highway and chosen at run time.
#include "soft_bound/newton_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "soft_bound/newton_lanes.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include <array>

#include "vector/choose_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Newton's method settles in a few rounds, at most about ten; a cap for what cannot be foreseen.
constexpr int kMostRounds = 60;
constexpr int kMostHalvings = 30;

/// Newton's rounds on as many lanes as a vector has. The tridiagonal system `K = Lap + diag clamp` is eliminated from
/// both ends toward the middle band: two chains that wait for one another only there, and free bands at either end have
/// a pivot of exactly 1.
template <class D, bool kHasPrior>
class Rounds {
  using V = hn::VFromD<D>;
  using M = hn::Mask<D>;
  static constexpr std::size_t kStride = NewtonLanes::kLanes;
  static constexpr std::size_t kMost = hn::MaxLanes(D());
  template <int rows>
  using Scratch = std::array<double, static_cast<std::size_t>(rows) * kMost>;

 public:
  Rounds(const SoftBoundSystem& system, NewtonLanes& lanes, std::size_t first)
      : m_system(system), m_lanes(lanes), m_first(first), m_count(system.bandCount), m_middle(system.bandCount / 2) {
    for (int k = 0; k < 3; ++k) {
      m_held[k] = given(m_lanes.held, k);
      m_multiplier[k] = zero();
    }
    m_most = m_mostWrong = m_clamped = zero();
    const V price = hn::Set(m_d, m_system.price);
    for (int b = 0; b < m_count; ++b) {
      const V clamp = hn::IfThenElseZero(hn::Lt(given(m_lanes.spectrum, b), zero()), price);
      take(m_lanes.clamp, b, clamp);
      m_clamped = hn::Add(m_clamped, clamp);
    }
    if constexpr (kHasPrior) {
      for (int b = 0; b < m_count; ++b) {
        V bend = zero();
        if (b > 0) {
          bend = hn::Add(bend, hn::Sub(given(m_lanes.prior, b), given(m_lanes.prior, b - 1)));
        }
        if (b + 1 < m_count) {
          bend = hn::Add(bend, hn::Sub(given(m_lanes.prior, b), given(m_lanes.prior, b + 1)));
        }
        put(m_bend, b, bend);
      }
    }
  }

  void run() {
    M active = hn::Gt(given(m_lanes.isUsed, 0), zero());
    V rounds = zero();
    V reached = objective<false>(zero(), active);
    for (int round = 0; !hn::AllFalse(m_d, active) && round < kMostRounds; ++round) {
      rounds = hn::Add(rounds, hn::IfThenElseZero(active, one()));
      solveSystem();
      const M goesOn = hn::AndNot(guessHolds(), active);
      V step = one();
      if (!hn::AllFalse(m_d, goesOn)) {
        V value = objective<true>(step, hn::Gt(zero(), one()));
        M worse = hn::And(goesOn, hn::Gt(value, reached));
        for (int halving = 0; !hn::AllFalse(m_d, worse) && halving < kMostHalvings; ++halving) {
          step = hn::IfThenElse(worse, hn::Mul(step, hn::Set(m_d, 0.5)), step);
          value = hn::IfThenElse(worse, objective<true>(step, worse), value);
          worse = hn::And(worse, hn::Gt(value, reached));
        }
        reached = hn::IfThenElse(goesOn, value, reached);
      }
      advance(active, goesOn, step);
      active = goesOn;
    }
    take(m_lanes.rounds, 0, rounds);
  }

 private:
  /// From one end of the bands inward: what is handed on to the next band.
  struct Chain {
    V inverse;  ///< of the pivot
    std::array<V, 3> weights;
    V bend;
  };

  HWY_INLINE V zero() const { return hn::Zero(m_d); }
  HWY_INLINE V one() const { return hn::Set(m_d, 1.0); }
  template <std::size_t size>
  HWY_INLINE V given(const std::array<double, size>& rows, int row) const {
    return hn::LoadU(m_d, rows.data() + static_cast<std::size_t>(row) * kStride + m_first);
  }
  template <std::size_t size>
  HWY_INLINE void take(std::array<double, size>& rows, int row, V value) const {
    hn::StoreU(value, m_d, rows.data() + static_cast<std::size_t>(row) * kStride + m_first);
  }
  HWY_INLINE V at(const Scratch<kConvergedBandCount>& rows, int row) const {
    return hn::LoadU(m_d, rows.data() + static_cast<std::size_t>(row) * hn::Lanes(m_d));
  }
  HWY_INLINE void put(Scratch<kConvergedBandCount>& rows, int row, V value) const {
    hn::StoreU(value, m_d, rows.data() + static_cast<std::size_t>(row) * hn::Lanes(m_d));
  }
  HWY_INLINE V weight(int band, int channel) const { return hn::Set(m_d, m_system.weights[3 * band + channel]); }

  HWY_INLINE Chain emptyChain() const { return {zero(), {zero(), zero(), zero()}, zero()}; }

  /// @param diagonal  of the roughness: 1 at the ends, else 2
  HWY_INLINE void stepInward(Chain& chain, int band, double diagonal) {
    const V pivot = hn::Sub(hn::Add(hn::Set(m_d, diagonal), given(m_lanes.clamp, band)), chain.inverse);
    for (int k = 0; k < 3; ++k) {
      chain.weights[k] = hn::Add(weight(band, k), hn::Mul(chain.weights[k], chain.inverse));
    }
    if constexpr (kHasPrior) {
      chain.bend = hn::Add(at(m_bend, band), hn::Mul(chain.bend, chain.inverse));
    }
    chain.inverse = hn::Div(one(), pivot);
    put(m_inverse, band, chain.inverse);
    addToSums(chain);
  }

  HWY_INLINE void addToSums(const Chain& chain) {
    std::size_t pair = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const V scaled = hn::Mul(chain.weights[i], chain.inverse);
      for (std::size_t j = i; j < 3; ++j, ++pair) {
        m_seen[pair] = hn::Add(m_seen[pair], hn::Mul(scaled, chain.weights[j]));
      }
      if constexpr (kHasPrior) {
        m_seenBend[i] = hn::Add(m_seenBend[i], hn::Mul(scaled, chain.bend));
      }
    }
  }

  /// `A K^-1 A'` and `A K^-1 bend`, from half the elimination: K^-1 = L'^-1 D^-1 L^-1.
  void eliminate() {
    m_seen.fill(zero());
    m_seenBend.fill(zero());
    Chain left = emptyChain();
    Chain right = emptyChain();
    const int last = m_count - 1;
    for (int b = 0; b < m_middle; ++b) {
      const double diagonal = b == 0 ? 1.0 : 2.0;
      stepInward(left, b, diagonal);
      if (last - b > m_middle) {
        stepInward(right, last - b, diagonal);
      }
    }
    Chain middle;
    middle.inverse = hn::Div(
        one(),
        hn::Sub(hn::Sub(hn::Add(hn::Set(m_d, 2.0), given(m_lanes.clamp, m_middle)), left.inverse), right.inverse));
    for (int k = 0; k < 3; ++k) {
      middle.weights[k] = hn::Add(hn::Add(weight(m_middle, k), hn::Mul(left.weights[k], left.inverse)),
                                  hn::Mul(right.weights[k], right.inverse));
    }
    middle.bend = zero();
    if constexpr (kHasPrior) {
      middle.bend =
          hn::Add(hn::Add(at(m_bend, m_middle), hn::Mul(left.bend, left.inverse)), hn::Mul(right.bend, right.inverse));
    }
    put(m_inverse, m_middle, middle.inverse);
    addToSums(middle);
  }

  /// The multipliers of the three equations, by cofactors, and once more for what is left: lights that hardly tell two
  /// channels apart lose half the digits.
  void solveEquations() {
    const V slack = hn::Set(m_d, m_system.slack);
    const V a = hn::Add(m_seen[0], slack);
    const V b = m_seen[1];
    const V c = m_seen[2];
    const V e = hn::Add(m_seen[3], slack);
    const V f = m_seen[4];
    const V i = hn::Add(m_seen[5], slack);
    const V aa = hn::Sub(hn::Mul(e, i), hn::Mul(f, f));
    const V ab = hn::Sub(hn::Mul(c, f), hn::Mul(b, i));
    const V ac = hn::Sub(hn::Mul(b, f), hn::Mul(c, e));
    const V ee = hn::Sub(hn::Mul(a, i), hn::Mul(c, c));
    const V ef = hn::Sub(hn::Mul(b, c), hn::Mul(a, f));
    const V ii = hn::Sub(hn::Mul(a, e), hn::Mul(b, b));
    const V inverse = hn::Div(one(), hn::Add(hn::Add(hn::Mul(a, aa), hn::Mul(b, ab)), hn::Mul(c, ac)));
    const std::array<V, 3> target = {hn::Sub(m_held[0], m_seenBend[0]), hn::Sub(m_held[1], m_seenBend[1]),
                                     hn::Sub(m_held[2], m_seenBend[2])};
    m_multiplier = {zero(), zero(), zero()};
    std::array<V, 3> left = target;
    for (int turn = 0; turn < 2; ++turn) {
      const auto [x, y, z] = left;
      m_multiplier[0] = hn::Add(m_multiplier[0], hn::Mul(inverse, dot(aa, x, ab, y, ac, z)));
      m_multiplier[1] = hn::Add(m_multiplier[1], hn::Mul(inverse, dot(ab, x, ee, y, ef, z)));
      m_multiplier[2] = hn::Add(m_multiplier[2], hn::Mul(inverse, dot(ac, x, ef, y, ii, z)));
      const auto [u, v, w] = m_multiplier;
      left = {hn::Sub(target[0], dot(a, u, b, v, c, w)), hn::Sub(target[1], dot(b, u, e, v, f, w)),
              hn::Sub(target[2], dot(c, u, f, v, i, w))};
    }
  }
  static HWY_INLINE V dot(V a, V x, V b, V y, V c, V z) {
    return hn::Add(hn::Add(hn::Mul(a, x), hn::Mul(b, y)), hn::Mul(c, z));
  }

  HWY_INLINE V load(int band) const {
    V sum = dot(m_multiplier[0], weight(band, 0), m_multiplier[1], weight(band, 1), m_multiplier[2], weight(band, 2));
    if constexpr (kHasPrior) {
      sum = hn::Add(sum, at(m_bend, band));
    }
    return sum;
  }

  /// The spectrum of the guess into m_next.
  void solveSystem() {
    eliminate();
    solveEquations();
    const int last = m_count - 1;
    V left = zero();
    V right = zero();
    for (int b = 0; b < m_middle; ++b) {
      left = hn::Add(load(b), left);
      put(m_next, b, left);
      left = hn::Mul(left, at(m_inverse, b));
      if (last - b > m_middle) {
        right = hn::Add(load(last - b), right);
        put(m_next, last - b, right);
        right = hn::Mul(right, at(m_inverse, last - b));
      }
    }
    m_most = m_mostWrong = zero();
    left = right = hn::Mul(hn::Add(hn::Add(load(m_middle), left), right), at(m_inverse, m_middle));
    propose(m_middle, left);
    for (int b = m_middle - 1; b >= 0; --b) {
      left = hn::Mul(hn::Add(at(m_next, b), left), at(m_inverse, b));
      propose(b, left);
      if (last - b > m_middle) {
        right = hn::Mul(hn::Add(at(m_next, last - b), right), at(m_inverse, last - b));
        propose(last - b, right);
      }
    }
    const M isFree = hn::Eq(m_clamped, zero());  // for which the system has no solution of its own
    if (!hn::AllFalse(m_d, isFree)) {
      m_most = hn::IfThenZeroElse(isFree, m_most);
      m_mostWrong = hn::IfThenZeroElse(isFree, m_mostWrong);
      for (int b = 0; b < m_count; ++b) {
        V smooth = zero();
        for (int k = 0; k < 3; ++k) {
          smooth = hn::Add(smooth, hn::Mul(hn::Set(m_d, m_system.smooth[3 * b + k]), given(m_lanes.tristimulus, k)));
        }
        if constexpr (kHasPrior) {
          smooth = hn::Add(smooth, given(m_lanes.prior, b));
        }
        propose(b, hn::IfThenElse(isFree, smooth, at(m_next, b)));
      }
    }
  }

  /// A band of the spectrum of the guess, and how large it is: among all bands, and among those that are on the other
  /// side of zero than guessed.
  HWY_INLINE void propose(int band, V value) {
    put(m_next, band, value);
    const V size = hn::Abs(value);
    const M isWrong = hn::Xor(hn::Lt(value, zero()), hn::Gt(given(m_lanes.clamp, band), zero()));
    m_most = hn::Max(m_most, size);
    m_mostWrong = hn::Max(m_mostWrong, hn::IfThenElseZero(isWrong, size));
  }

  /// Where the bands below zero are those of the guess.
  M guessHolds() const { return hn::Not(hn::Gt(m_mostWrong, hn::Mul(hn::Set(m_d, kNothing), m_most))); }

  /// Of lanes that are to go part of the way from where they are; the others go to m_next.
  HWY_INLINE V between(int band, V step, M partly) const {
    const V from = given(m_lanes.spectrum, band);
    const V whole = at(m_next, band);
    return hn::IfThenElse(partly, hn::Add(from, hn::Mul(step, hn::Sub(whole, from))), whole);
  }

  /// What is minimised. @tparam kAhead  of between(step, partly); else of where lanes are
  template <bool kAhead>
  V objective(V step, M partly) const {
    V rough = zero();
    V below = zero();
    std::array<V, 3> missed = m_held;
    V before = zero();
    for (int b = 0; b < m_count; ++b) {
      const V value = kAhead ? between(b, step, partly) : given(m_lanes.spectrum, b);
      V deviation = value;
      if constexpr (kHasPrior) {
        deviation = hn::Sub(value, given(m_lanes.prior, b));
      }
      if (b > 0) {
        const V difference = hn::Sub(deviation, before);
        rough = hn::Add(rough, hn::Mul(difference, difference));
      }
      before = deviation;
      const V low = hn::Min(value, zero());
      below = hn::Add(below, hn::Mul(low, low));
      if (m_system.relaxation > 0.0) {
        for (int k = 0; k < 3; ++k) {
          missed[k] = hn::Sub(missed[k], hn::Mul(weight(b, k), value));
        }
      }
    }
    V sum = hn::Add(rough, hn::Mul(hn::Set(m_d, m_system.price), below));
    if (m_system.relaxation > 0.0) {
      sum = hn::Add(sum, hn::Mul(hn::Set(m_d, m_system.relaxation),
                                 dot(missed[0], missed[0], missed[1], missed[1], missed[2], missed[2])));
    }
    return sum;
  }

  /// Lanes that were active take the step, and those that go on the bands that it leaves below zero as the next guess.
  void advance(M active, M goesOn, V step) {
    const M partly = hn::Lt(step, one());
    const V price = hn::Set(m_d, m_system.price);
    m_clamped = zero();
    for (int b = 0; b < m_count; ++b) {
      const V value = hn::IfThenElse(active, between(b, step, partly), given(m_lanes.spectrum, b));
      take(m_lanes.spectrum, b, value);
      const V clamp = hn::IfThenElse(goesOn, hn::IfThenElseZero(hn::Lt(value, zero()), price), given(m_lanes.clamp, b));
      take(m_lanes.clamp, b, clamp);
      m_clamped = hn::Add(m_clamped, clamp);
    }
  }

  const D m_d{};
  const SoftBoundSystem& m_system;
  NewtonLanes& m_lanes;
  std::size_t m_first;
  int m_count;
  int m_middle;
  std::array<V, 3> m_held;
  std::array<V, 3> m_multiplier;
  std::array<V, 6> m_seen;
  std::array<V, 3> m_seenBend;
  V m_clamped;    ///< sum of the guess's clamps
  V m_most;       ///< largest |m_next|
  V m_mostWrong;  ///< of the bands that are not as guessed
  Scratch<kConvergedBandCount> m_bend;
  Scratch<kConvergedBandCount> m_inverse;
  Scratch<kConvergedBandCount> m_next;
};

template <class D>
void solveLanes(const SoftBoundSystem& system, NewtonLanes& lanes, std::size_t count) {
  for (std::size_t first = 0; first < count; first += hn::Lanes(D())) {
    if (lanes.hasPrior) {
      Rounds<D, true>(system, lanes, first).run();
    } else {
      Rounds<D, false>(system, lanes, first).run();
    }
  }
}

void solveByNewtonHere(const SoftBoundSystem& system, NewtonLanes& lanes, std::size_t count) {
  if (count <= NewtonLanes::kFew) {
    solveLanes<hn::CappedTag<double, NewtonLanes::kFew>>(system, lanes, count);
  } else {
    solveLanes<hn::CappedTag<double, NewtonLanes::kLanes>>(system, lanes, count);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

namespace {

using SolveByNewton = void(const SoftBoundSystem&, NewtonLanes&, std::size_t);

}  // namespace

void solveByNewton(const SoftBoundSystem& system, NewtonLanes& lanes, std::size_t count) {
  METAMER_CHOOSE_KERNEL(SolveByNewton, solveByNewtonHere)(system, lanes, count);
}

}  // namespace metamer::sip
#endif
