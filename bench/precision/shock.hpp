#pragma once
// The paper's shock, from the first collision into the collapsed cluster: two rows approach at speeds 1/2 and -1/2,
// with a velocity cut-off of 1e-5 and every particle displaced by a hash of its number. Two quantities are measured for
// each engine:
//
//   errors   of energy, front and gaps (median of their relative errors) at given times
//   order    the first collision out of order. The digests of two runs' traces are sampled at many times. The runs
//            disagree from the first sample after which digests always differ (a sample between the two runs' times
//            of one collision differs only there)

#include <algorithm>
#include <optional>
#include <type_traits>

#include "cradle/core/observe/trace.hpp"
#include "engines.hpp"

namespace precision {

struct ShockScene {
  std::string name;
  ParticleIndex particles;
  const char* restitution;
  std::vector<double> times;  // of the errors; the run ends with the last
  std::uint64_t collisions;   // of the whole run: decides the distance of samples
};

template <class Chain> Run<Chain> prepare(const ShockScene& scene) {
  using T = typename Chain::Scalar;
  return {cradle::Inelastic<T>(cradle::from_text<T>(scene.restitution), cradle::from_text<T>("1e-5")),
          Chain(bench::rows<T>(scene.particles), T(0))};
}

// ---- errors

struct ShockState {
  std::uint64_t collisions = 0;
  Wide energy, front;
  ParticleIndex first = 0;  // particle on the left of the first gap
  std::vector<Wide> gaps;   // of the particles that have collided and the next one on either side
};

template <class Chain> ShockState read(const Run<Chain>& run, const ShockScene& scene, double time) {
  const auto local = run.chain().local_time(typename Chain::Scalar(time));
  const auto configuration = run.chain().configuration(local);
  ShockState state{run.counts().collisions,
                   Wide(scene.particles) / 8 - widen(run.energy_lost()),
                   widen(run.chain().front_right(local)),
                   configuration.index.front(),
                   {}};
  for (const auto& gap : configuration.gap) state.gaps.push_back(widen(gap));
  return state;
}

struct ShockErrors {
  double energy, front, gaps;
};

inline ShockErrors errors(const ShockState& state, const ShockState& exact) {
  std::vector<double> gaps;
  for (std::size_t k = 0; k < exact.gaps.size(); ++k) {
    const ParticleIndex j = exact.first + static_cast<ParticleIndex>(k) - state.first;
    const bool held = j >= 0 && j < static_cast<ParticleIndex>(state.gaps.size());
    gaps.push_back(held ? relative_error(state.gaps[static_cast<std::size_t>(j)], exact.gaps[k]) : 1);
  }
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return {relative_error(state.energy, exact.energy), relative_error(state.front, exact.front), *middle};
}

// ---- order

inline constexpr std::uint64_t samples = 4000;

// Sampling times: at regular numbers of collisions of the run in gaps in double, halfway to the next collision; and the
// end.
inline std::vector<double> sampling_times(const ShockScene& scene) {
  std::vector<double> times;
  std::uint64_t made = 0;
  const std::uint64_t stride = scene.collisions / samples;
  auto simulation = prepare<cradle::GapChain<double>>(scene);
  simulation.advance(scene.times.back(), [&](const cradle::Collision<double>& collision) {
    if (++made % stride == 0) times.push_back(collision.time.value() - collision.interval / 2);
  });
  times.push_back(scene.times.back());
  return times;
}

struct Sample {
  double time;
  std::uint64_t digest, collisions;
};

// The last sample in which both digests agree; nothing if that is the end of both runs.
inline std::optional<Sample> last_agreement(const std::vector<Sample>& a, const std::vector<Sample>& b) {
  std::size_t k = std::min(a.size(), b.size());
  if (a[k - 1].digest == b[k - 1].digest) return std::nullopt;
  while (k > 0 && a[k - 1].digest != b[k - 1].digest) --k;
  return k > 0 ? a[k - 1] : Sample{0, 0, 0};
}

// ---- runs

struct ShockRun {
  double seconds = 0;  // includes tracing
  std::vector<ShockState> states;
  std::vector<Sample> samples;
};

// With sampling times the run is traced; without, it runs as for a user.
inline ShockRun run(const Engine& engine, const ShockScene& scene, const std::vector<double>& sampling = {}) {
  return with_chain<ShockRun>(engine, [&]<class Chain>(std::type_identity<Chain>) {
    using T = typename Chain::Scalar;
    ShockRun result;
    Run<Chain> simulation = prepare<Chain>(scene);
    cradle::Trace trace;
    const auto advance = [&](double until) {
      if (sampling.empty())
        simulation.advance(T(until));
      else
        simulation.advance(
            T(until), [&](const cradle::Collision<T>& collision) { trace.collision(collision.left, collision.right); });
    };
    auto next = sampling.begin();
    for (const double time : scene.times) {
      const double start = bench::seconds_now();
      for (; next != sampling.end() && *next <= time; ++next) {
        advance(*next);
        result.samples.push_back({*next, trace.digest(), simulation.counts().collisions});
      }
      advance(time);
      result.seconds += bench::seconds_now() - start;
      result.states.push_back(read(simulation, scene, time));
    }
    return result;
  });
}

}  // namespace precision
