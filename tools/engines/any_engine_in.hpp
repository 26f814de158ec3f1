// The engine of a run in one scalar type: what code for all types requires of it (any_engine.hpp).
#pragma once

#include <concepts>
#include <limits>

#include "cradle/core/base/fields.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/engines/engine_of.hpp"
#include "cradle/tools/engines/run_state_in.hpp"

namespace cradle::tools {

template <Real T> Incident<Number> reported(const Incident<T>& i) {
  return {number_of(i.time), i.particle, number_of(i.gap)};
}

template <Real T> struct CollisionIn final : ObservedCollision {
  explicit CollisionIn(const Collision<T>& c) : of(c) {
    left = c.left, right = c.right;
    time = to_double(T(c.time.value())), interval = rounded(c.interval), closing_speed = rounded(c.closing_speed);
  }
  double time_low() const override { return to_double(difference(of.time, Pair<T>{T(time), T(0)})); }
  Texts texts() const override {
    return {to_text(T(of.time.value())), to_text(of.interval), to_text(of.closing_speed)};
  }
  const Collision<T>& of;
};

template <Real T> class AnyEngineIn final : public AnyEngine {
 public:
  AnyEngineIn(const Scene& scene, const EngineOptions& options)
      : options_(options), run_{scene, initial_particles<T>(scene), number<T>(scene.run.start), {}},
        energy_(run_.particles->mechanical_energy()), last_checked_(run_.start) {
    run_.engine = engine();
  }

  void begin_again() override {
    run_.particles = initial_particles<T>(run_.scene);
    // Random masses may be ones that need to be watched.
    if (!run_.scene.initial.random_masses.empty() || !run_.engine->begin_again(run_.particles)) run_.engine = engine();
    energy_ = run_.particles->mechanical_energy(), last_checked_ = run_.start;
    run_.tagged.reset(), histograms_.reset();
  }

  Status advance(const Number& until, const CollisionObserver& observer) override {
    return run_.engine->advance(exact_in<T>(until), observer_in(observer));
  }
  Status step(std::uint64_t& left, const Number& until, const CollisionObserver& observer) override {
    return run_.engine->step(left, exact_in<T>(until), observer_in(observer));
  }

  const Counts& counts() const override { return run_.engine->counts(); }
  Number last_collision_time() const override { return number_of(run_.engine->last_collision_time()); }
  ParticleIndex particles() const override { return run_.particles->count(); }
  ParticleIndex collided_particles() const override { return run_.engine->collided_particles(); }
  Account<Number> account() const override {
    const Account<T>& a = run_.engine->account();
    return {a.simultaneous,
            a.order_lost,
            reported(a.first_order_lost),
            a.unresolved,
            reported(a.first_unresolved),
            a.uncertain,
            reported(a.first_uncertain)};
  }
  ReportedCollapse collapse() const override {
    const CollapseReport<T>& r = *run_.engine->collapse();
    return {number_of(r.last_collision),
            number_of(r.interval),
            number_of(r.gap),
            r.particle,
            r.settled,
            number_of(T(r.time.value())),
            number_of(r.uncertainty),
            number_of(r.ratio),
            number_of(r.ratio_uncertainty)};
  }
  long double epsilon() const override { return from_text<long double>(to_text(T(std::numeric_limits<T>::epsilon()))); }

  std::unique_ptr<RunState> state_at(const RunTime& time, bool at_collision) override {
    return std::make_unique<RunStateIn<T>>(run_, time, at_collision);
  }

  CheckedParticles check(const Number& at) override {
    const Engine<T>& engine = *run_.engine;
    const T time = exact_in<T>(at), last = engine.last_collision_time();
    const Account<T>& account = engine.account();
    const Configuration<T> now = engine.configuration(time);
    const GuardCheck<T> found =
        guarded(now, *run_.particles, counts().collisions, T(energy_ - engine.energy_lost(time)), T(time - run_.start),
                last, last_checked_, account.order_lost + account.unresolved == 0);
    last_checked_ = last;
    return {found.broken ? std::optional(reported(*found.broken, time)) : std::nullopt, to_double(found.gap_min),
            to_double(found.closure_gap), to_double(found.closure_speed),
            static_cast<std::uint64_t>(now.to - now.from + 1) - now.x.size()};
  }
  bool collided_since_check() const override { return last_checked_ < run_.engine->last_collision_time(); }

  void count_collisions(const Counting& counting, const OctaveBins& bins, bool flights) override {
    histograms_.emplace(number<T>(counting.from), number<T>(counting.until), bins, particles(), flights);
  }
  std::array<std::vector<std::uint64_t>, 5> counted_collisions() override {
    if (!histograms_) return {};
    histograms_->made(counts());
    return {histograms_->free_flights.counts(), histograms_->pair_flights.counts(),
            histograms_->closing_speeds.counts(), histograms_->dissipative_speeds.counts(),
            histograms_->collisions_per_particle().counts()};
  }
  std::size_t tag(ParticleIndex every) override { return run_.tagged.emplace(*run_.particles, every).size(); }

  void save(StateSink& to) const override {
    run_.engine->save(to);
    cradle::save(to, *this);
  }
  void load(StateSource& from) override {
    run_.engine->load(from);
    cradle::load(from, *this);
  }
  std::string shape() const override {
    return run_.engine->shape() + state_shape<AnyEngineIn>() + (std::same_as<T, double> ? "" : "exact");
  }
  static auto state(auto& self) { return fields(self.last_checked_, self.histograms_); }

 private:
  std::unique_ptr<Engine<T>> engine() const {
    Policy<T> policy = policy_of<T>(run_.scene, options_.restitution != nullptr);
    policy.interrupt = options_.interrupt;
    policy.progress = [report = options_.progress](const T& time, const Counts& counts) {
      report(to_double(time), counts);
    };
    if constexpr (std::same_as<T, double>)
      if (options_.restitution) return engine_with(options_.restitution, run_.scene, run_.particles, policy);
    return engine_of<T>(run_.scene, run_.particles, policy, options_.workers, options_.observed);
  }
  // The caller's observer comes first, so that a collision is not counted if it throws.
  Observer<T> observer_in(const CollisionObserver& observer) {
    if (!observer && !histograms_) return {};
    return [this, &observer](const Collision<T>& c) {
      if (observer) observer(CollisionIn<T>(c));
      if (!histograms_) return;
      histograms_->made(counts());
      (*histograms_)(c);
    };
  }

  EngineOptions options_;
  RunIn<T> run_;
  T energy_;
  T last_checked_;  // the time of the last collision before the last check
  std::optional<CollisionHistograms<T>> histograms_;
};

template <class T> std::unique_ptr<AnyEngine> begin_engine_in(const Scene& scene, const EngineOptions& options) {
  return std::make_unique<AnyEngineIn<T>>(scene, options);
}

}  // namespace cradle::tools
