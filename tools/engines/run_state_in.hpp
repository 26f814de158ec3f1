// Numbers and the state of a run at one time in one scalar type: what code for all types requires of them
// (any_engine.hpp).
#pragma once

#include <algorithm>
#include <concepts>

#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/correlations.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/engines/engine_of.hpp"

namespace cradle::tools {

template <Real T> struct ExactIn final : ExactNumber {
  explicit ExactIn(const T& x) : value(x) {}
  std::string text() const override { return to_text(value); }
  bool is_less(const ExactNumber& other) const override { return value < static_cast<const ExactIn&>(other).value; }
  const T value;
};

template <Real T> double rounded(const T& x) { return x == x ? to_double(x) : none(); }

template <Real T> Number number_of(const T& x) {
  if constexpr (std::same_as<T, double>)
    return {rounded(x), nullptr};
  else
    return {rounded(x), std::make_shared<ExactIn<T>>(x)};
}
template <Real T> std::optional<Number> number_of(const std::optional<T>& x) {
  return x ? std::optional(number_of(*x)) : std::nullopt;
}
template <Real T> T exact_in(const Number& x) {
  if constexpr (std::same_as<T, double>)
    return x.value;
  else
    return static_cast<const ExactIn<T>&>(*x.exact).value;
}

template <Real T> Number rounded_once(std::string_view decimal) { return number_of(from_text<T>(decimal)); }

template <Real T> ReportedGuard reported(const GuardReport<T>& r, const T& time) {
  return {r.guard, to_double(r.found), to_double(r.bound), r.particle, number_of(time)};
}

/// What a state needs of its run.
template <Real T> struct RunIn {
  const Scene& scene;
  std::shared_ptr<const cradle::Particles<T>> particles;
  T start;
  std::unique_ptr<Engine<T>> engine;
  std::optional<TaggedParticles<T>> tagged = {};
};

template <Real T> class RunStateIn final : public RunState {
 public:
  RunStateIn(RunIn<T>& of, const RunTime& at, bool at_collision)
      : RunState(at), of_(of), run_(*of.engine), particles_(*of.particles), time_(exact_in<T>(at.exact)),
        elapsed_(time_ - of.start), at_collision_(at_collision) {}

  const SampledState& state() const override {
    return computed(state_, [&] {
      const Sample<T>& s = sampled();
      const auto wall = [](const WallTally<T>& w) {
        return SampledState::Wall{w.collisions, number_of(T(w.given.value())), number_of(T(w.momentum.value())),
                                  number_of(T(w.dissipated.value()))};
      };
      return SampledState{number_of(s.energy),
                          number_of(s.energy_lost),
                          s.counts,
                          s.particles,
                          number_of(s.front_left),
                          number_of(s.front_right),
                          {wall(s.walls[0]), wall(s.walls[1])}};
    });
  }

  std::vector<double> column(Column which) const override {
    return made_of<double>(which, [](const T& x) { return rounded(x); });
  }
  std::vector<std::string> column_text(Column which) const override {
    return made_of<std::string>(which, [](const T& x) { return to_text(x); });
  }
  const std::vector<ParticleIndex>& index() const override { return configuration().index; }
  std::pair<ParticleIndex, ParticleIndex> range() const override { return {configuration().from, configuration().to}; }
  BinRange ends() const override {
    const Configuration<T>& c = configuration();
    const bool any = c.collided_from < c.collided_to;
    return {rounded(c.x[any ? c.collided_from : 0]), rounded(c.x[any ? c.collided_to - 1 : c.x.size() - 1])};
  }
  std::vector<std::pair<std::string, Number>> gap_numbers() const override {
    const Configuration<T>& c = configuration();
    if (c.x.size() < 2) return {};
    const GapStatistics<T> gaps = gap_statistics(c);
    std::vector<std::pair<std::string, Number>> all{{"gap_min", number_of(gaps.least)},
                                                    {"gap_median", number_of(gaps.median)}};
    if (c.closure_gap) all.emplace_back("closure_gap", number_of(*c.closure_gap));
    if (c.closure_speed) all.emplace_back("closure_speed", number_of(*c.closure_speed));
    return all;
  }
  std::unique_ptr<RunState> after_last_collision() const override {
    return std::make_unique<RunStateIn>(of_, time, true);
  }

  std::vector<Number> at_start(Column which, ParticleIndex first, ParticleIndex last) const override {
    std::vector<Number> all;
    for (ParticleIndex b = first; b <= last; ++b)
      all.push_back(which == Column::x                                   ? number_of(particles_.position(b))
                    : which == Column::v                                 ? number_of(particles_.velocity(b))
                    : which == Column::m                                 ? number_of(particles_.mass(b))
                    : b + 1 < particles_.count() || particles_.on_ring() ? number_of(particles_.gap(b))
                                                                         : Number{none(), nullptr});
    return all;
  }
  Number circumference() const override { return number_of(particles_.circumference()); }
  double least_mass() const override { return to_double(particles_.least_mass()); }
  Number energy_at_start() const override { return number_of(particles_.kinetic_energy()); }

  const SampledCloud& cloud() const override {
    return computed(sampled_cloud_, [&] {
      const Cloud<T>& c = cloud_in();
      const auto heaviest = [](const std::optional<Cluster<T>>& of) -> std::optional<SampledCloud::Heaviest> {
        if (!of) return {};
        return SampledCloud::Heaviest{number_of(of->mass), number_of(of->x), number_of(of->v), of->index};
      };
      return SampledCloud{heaviest(c.left), heaviest(c.right), number_of(c.mass), number_of(c.width)};
    });
  }
  const DenseCore& core() const override {
    return computed(core_, [&] { return dense_core(configuration()); });
  }
  Number potential_energy() const override {
    return number_of(cradle::potential_energy(configuration(), particles_, elapsed_));
  }
  // The difference of the two ledgers of losses, in which what they share cancels.
  Number sticky_excess() const override {
    StickyGas<T> sticky(of_.particles, of_.start);  // a new one: the result must not depend on earlier samples
    sticky.advance(time_);
    const T energy = particles_.kinetic_energy();
    return number_of(T(T(energy - run_.energy_lost(time_)) - (energy - sticky.energy_lost())));
  }
  std::vector<std::uint64_t> mass_distribution() const override {
    return cradle::mass_distribution(configuration(), particles_.least_mass());
  }
  void for_each_cluster(const Decimal& gap, const std::function<void(std::size_t)>& visit) const override {
    cradle::for_each_cluster(configuration(), number<T>(gap), visit);
  }
  TaggedMotion tagged() const override {
    of_.tagged->find(configuration(), elapsed_);
    return {of_.tagged->displacement(), of_.tagged->velocity()};
  }

  void find(TimeAverages& averages, const Stopped& stopped) const override {
    averages.find(configuration(), particles_, elapsed_, stopped);
  }
  void find(ZoneAverage& zone, const Stopped& stopped) const override {
    zone.find(configuration(), particles_, elapsed_, stopped);
  }
  std::vector<double> measured(const StructureFactor& structure, const Stopped& stopped) const override {
    return structure(configuration(), particles_, elapsed_, stopped);
  }
  std::vector<double> measured(const PairDistribution& pairs, const Stopped& stopped) const override {
    return pairs(configuration(), particles_, elapsed_, stopped);
  }
  Profile profile(BinRange range, std::size_t bins, const Stopped& stopped) const override {
    return cradle::profile(configuration(), particles_, elapsed_, range, bins, stopped);
  }
  void sample(ScenarioWatch& watch) const override {
    watch.sample(cloud_in(), to_double(elapsed_), run_.counts().merges);
  }

  const char* beyond_range(bool of_particles) const override {
    const auto any = [](const auto& numbers) {
      return !std::ranges::all_of(numbers, [](const T& x) { return is_finite(x); });
    };
    if (of_particles) return any(configuration().x) ? "a position" : any(configuration().v) ? "a velocity" : nullptr;
    const Sample<T>& s = sampled();
    if (!is_finite(s.energy)) return "the energy";
    const bool held = is_finite(s.front_left.value_or(T(0))) && is_finite(s.front_right.value_or(T(0)));
    return held ? nullptr : "a front";
  }
  std::optional<ReportedGuard> beyond_a_wall() const override {
    const auto found = cradle::beyond_a_wall(run_, particles_, time_, elapsed_);
    return found ? std::optional(reported(*found, time_)) : std::nullopt;
  }

  std::optional<ParticleIndex> uncertain() const override { return run_.uncertain_at(time_); }
  double ledger_error() const override {
    T error = particles_.kinetic_energy() - run_.energy_lost(time_) - run_.kinetic_energy(time_);
    if (particles_.fall())
      error += particles_.potential_energy() - cradle::potential_energy(configuration(), particles_, elapsed_);
    return to_double(error);
  }
  std::optional<double> energy_deviation(double of) const override {
    const std::optional<T> off = run_.energy_deviation(time_);
    if (!off) return {};
    return to_double(T(*off / exactly<T>(of)));
  }

 private:
  template <class Value, class F> static const Value& computed(std::optional<Value>& value, F f) {
    if (!value) value.emplace(f());
    return *value;
  }
  template <class Value, class F> static const Value& computed(std::unique_ptr<const Value>& value, F f) {
    if (!value) value = std::make_unique<const Value>(f());
    return *value;
  }
  const Sample<T>& sampled() const {
    return computed(sample_, [&] { return run_.sample(particles_.kinetic_energy(), time_); });
  }
  const Configuration<T>& configuration() const {
    return computed(configuration_,
                    [&] { return at_collision_ ? run_.configuration_at_last_collision() : run_.configuration(time_); });
  }
  const Cloud<T>& cloud_in() const {
    return computed(cloud_, [&] { return cradle::cloud(configuration()); });
  }
  template <class Made, class F> std::vector<Made> made_of(Column which, const F& make) const {
    const Configuration<T>& c = configuration();
    const auto& of = *std::array{&c.x, &c.v, &c.m, &c.gap, &c.closing_speed}[static_cast<std::size_t>(which)];
    std::vector<Made> all;
    all.reserve(of.size());
    for (const T& x : of) all.push_back(make(x));
    return all;
  }

  RunIn<T>& of_;
  const Engine<T>& run_;
  const cradle::Particles<T>& particles_;
  T time_, elapsed_;
  bool at_collision_;
  mutable std::optional<Sample<T>> sample_;
  mutable std::optional<SampledState> state_;
  mutable std::unique_ptr<const Configuration<T>> configuration_;  // these are not of every sample
  mutable std::unique_ptr<const Cloud<T>> cloud_;
  mutable std::unique_ptr<const SampledCloud> sampled_cloud_;
  mutable std::unique_ptr<const DenseCore> core_;
};

}  // namespace cradle::tools
