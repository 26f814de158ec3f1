// The checker of core/certify beside a run, in one kind of balls. Compiled once per kind (tools/CMakeLists.txt).
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>

#include "cradle/core/certify/checker.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/tools/certify/agreement.hpp"
#include "cradle/tools/certify/certificate.hpp"
#include "cradle/tools/run/initial_state.hpp"

namespace cradle::tools {

template <Enclosing N> CertainLaw<N> certain_law(const Scene& scene) {
  using Kind = typename CertainLaw<N>::Kind;
  CertainLaw<N> law;
  if (scene.law.type == LawType::sticky) {
    law.kind = Kind::sticky;
    return law;
  }
  if (scene.law.type == LawType::wet) {
    law.kind = Kind::wet;
    law.loss = number<N>(scene.law.loss);
    return law;
  }
  law.restitution = number<N>(scene.law.restitution);
  law.elastic = scene.law.restitution == Decimal("1");
  if (scene.run.collapse == tools::CollapsePolicy::merge) {
    law.kind = Kind::merging;
    law.merge_speed = number<N>(scene.run.merge_speed);
    return law;
  }
  // To elastic bodies a cut-off does nothing.
  if (!law.elastic && scene.law.cutoff > Decimal("0")) law.cutoff = number<N>(scene.law.cutoff);
  if (!law.elastic && scene.run.collapse == tools::CollapsePolicy::contact_time)
    law.contact_time = number<N>(scene.run.contact_time);
  return law;
}

template <class M> class CertifierIn final : public Certifier {
  using N = Ball<M>;
  using Kind = typename CertainLaw<N>::Kind;

 public:
  CertifierIn(const Scene& scene, unsigned digits)
      : start_(number<N>(scene.run.start)), law_(certain_law<N>(scene)), bodies_(initial_bodies<N>(scene)),
        means_(law_.kind != Kind::merging && (law_.kind != Kind::inelastic || bodies_->identical_masses())),
        checker_(bodies_, law_) {
    certificate_.digits = digits;
    certificate_.digits_text = digits == 31 ? "double-double" : fmt::format("mpfr, {} digits", digits);
    if (const auto doubt = checker_.begin()) certificate_.doubt = told(*doubt, scene.run.start.value);
  }

  void contact(BodyIndex left, BodyIndex right, double time) override {
    if (certificate_.doubt) throw ProofEnds();
    const auto doubt = checker_.contact(left, right);
    if (!doubt) return;
    certificate_.doubt = told(*doubt, time);
    throw ProofEnds();
  }

  void look(const RunLook& look) override {
    if (certificate_.doubt) throw ProofEnds();
    for (const AskedTime& asked : look.asked) look_at(asked, look);
  }

  Certificate certificate() const override {
    Certificate all = certificate_;
    all.contacts = checker_.proved().contacts;
    all.in_doubles = checker_.proved().in_doubles;
    return all;
  }

 private:
  static Enclosed enclosed(const N& x) { return {in_decimals(x), in_doubles(x), static_cast<long double>(x.radius())}; }
  static std::string middle(const N& x) { return to_text(x.middle()); }
  ToldDoubt told(const Doubt<N>& doubt, double time) const {
    return {doubt.check,
            doubt.refuted,
            doubt.left,
            doubt.right,
            time,
            checker_.proved().contacts,
            middle(doubt.first),
            middle(doubt.second),
            static_cast<long double>(doubt.first.radius() + doubt.second.radius())};
  }

  void look_at(const AskedTime& asked, const RunLook& look) {
    const N time = number<N>(asked.time) - start_;
    const CertainState<N> state = look.at_contact ? checker_.state_now() : checker_.state_at(time);
    snapshots_ += asked.of_snapshots;
    if (state.doubt) {
      // A contact just at the time of a sample leaves that open, not what comes after.
      if (!asked.last) return;
      certificate_.doubt = told(*state.doubt, look.time);
    } else {
      compare(look, asked, time, state);
    }
    if (certificate_.doubt) throw ProofEnds();
    add_sample(look, asked, state);
    if (asked.of_snapshots) add_snapshot(time, look.time);
  }

  // All that the run has of what is proved of it. A contact on the wrong side of a threshold need not change their
  // sequence; and what the program gets wrong here or there would be called proved.
  void compare(const RunLook& look, const AskedTime& asked, const N& time, const CertainState<N>& state) {
    const auto& proved = checker_.proved();
    const long double since = std::abs(to_double(time)) + 2 * std::abs(to_double(start_));
    RunErrors errors =
        run_errors(state.sizes, proved.contacts, means_, look.epsilon, since, to_double(bodies_->circumference()));
    if (law_.kind == Kind::wet)
      errors.of_radius = look.epsilon / of_balls() * (static_cast<long double>(state.sizes.bodies) + 64);
    Agreement<N> run(errors);
    run.count("contacts", look.counts.contacts, proved.contacts);
    run.count("merges", look.counts.merges, proved.merges);
    // To elastic bodies a cut-off does nothing, and none of them is counted here.
    if (!law_.elastic) run.count("contacts_below_cutoff", look.counts.below_cutoff, proved.below_cutoff);
    if (look.at_contact)
      run.number("time of the last contact", look.time_text, start_ + state.time, time_error(errors, since, state));
    else
      run.number("time of the sample", look.time_text, number<N>(asked.time), 8 * look.epsilon * since);
    run.number("energy", look.energy, state.energy, errors.energy);
    run.place("front_left", look.front_left, state.front_left);
    run.place("front_right", look.front_right, state.front_right);
    if (asked.of_snapshots) compare_bodies(look.bodies, time, run);
    if (const auto& broken = run.broken())
      certificate_.doubt = ToldDoubt{
          Check::agreement, true, -1, -1, look.time, proved.contacts, broken->of_run, broken->of_proof, broken->bound,
          broken->quantity};
  }
  static long double time_error(const RunErrors& errors, long double since, const CertainState<N>& state) {
    const auto closing = static_cast<long double>(state.closing.least_size());
    return closing > 0 ? 2 * (errors.place + since * errors.speed) / closing + errors.place
                       : std::numeric_limits<long double>::infinity();
  }
  static long double of_balls() { return from_text<long double>(to_text(M(std::numeric_limits<M>::epsilon()))); }

  void compare_bodies(const LookedBodies& bodies, const N& time, Agreement<N>& run) const {
    std::unordered_map<BodyIndex, std::size_t> at;  // by cluster
    for (std::size_t j = 0; j < bodies.index.size(); ++j)
      if (const auto cluster = checker_.cluster(bodies.index[j]))
        run.count("bodies of the snapshot in one cluster", at.emplace(*cluster, j).second ? 1 : 2, 1);
    checker_.for_each(time, [&](BodyIndex body, const N& m, const N& x, const N& v) {
      const auto found = at.find(body);
      const bool there = found != at.end();
      if (!there && (body < bodies.from || body > bodies.to)) return;
      const auto number = [&](const char* what, const std::vector<std::string>& all, const N& of_proof,
                              long double bound) {
        run.number(fmt::format("{} of body {} in the snapshot", what, body), there ? all[found->second] : "", of_proof,
                   bound);
      };
      number("m", bodies.m, m, run.errors().mass);
      number("x", bodies.x, there ? nearest_image(x, bodies.x[found->second]) : x, run.errors().place);
      number("v", bodies.v, v, run.errors().speed);
    });
  }
  // On a ring: the run folds places to one circumference.
  N nearest_image(const N& x, const std::string& of_run) const {
    if (!bodies_->on_ring() || of_run.find('n') != of_run.npos) return x;
    const N length = bodies_->circumference();
    return x + N(std::round(to_double(N((from_text<N>(of_run) - x) / length)))) * length;
  }

  void add_sample(const RunLook& look, const AskedTime& asked, const CertainState<N>& state) {
    CertainSample sample{
        look.time, asked.time.text, asked.of_series, checker_.proved().contacts, enclosed(state.energy), {},
        {},        state.widest,    state.least_gap, state.widest_of_gap};
    if (state.front_left) sample.front_left = enclosed(*state.front_left);
    if (state.front_right) sample.front_right = enclosed(*state.front_right);
    certificate_.samples.push_back(std::move(sample));
  }

  void add_snapshot(const N& time, double of_run) {
    const std::size_t number = snapshots_ - 1;  // that of the run's
    Group doubles{fmt::format("certificate/snapshots/{:04}", number), {{"time", of_run}}, {}},
        exact{fmt::format("exact/snapshots/{:04}", number), {{"time", of_run}}, {}};
    std::vector<std::uint64_t> index;
    std::vector<double> ends[4];
    std::vector<std::string> decimals[4];
    checker_.for_each(time, [&](BodyIndex body, const N&, const N& x, const N& v) {
      index.push_back(static_cast<std::uint64_t>(body));
      const Enclosed place = enclosed(x), velocity = enclosed(v);
      for (const auto& [at, of] : {std::pair{0, &place}, {2, &velocity}}) {
        ends[at].push_back(of->doubles.low), ends[at + 1].push_back(of->doubles.high);
        decimals[at].push_back(of->decimals.low), decimals[at + 1].push_back(of->decimals.high);
      }
    });
    constexpr const char* names[] = {"x_low", "x_high", "v_low", "v_high"};
    constexpr const char* units[] = {"l", "l", "l/t", "l/t"};
    for (Group* group : {&doubles, &exact}) {
      group->columns.push_back({"index", "1", "of a body of the cluster, at the start", index});
      group->columns.back().names = true;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      doubles.columns.push_back({names[k], units[k], "bound, rounded outwards", ends[k]});
      exact.columns.push_back({names[k], units[k], "bound, all digits that are known", decimals[k]});
    }
    certificate_.snapshots.push_back(std::move(doubles));
    certificate_.snapshots.push_back(std::move(exact));
  }

  N start_;
  CertainLaw<N> law_;
  std::shared_ptr<const cradle::Bodies<N>> bodies_;
  bool means_;  // velocities after a contact are means of those before
  Checker<N> checker_;
  Certificate certificate_;
  std::size_t snapshots_ = 0;  // that the run has taken
};

template <class M> std::unique_ptr<Certifier> certifier_in(const Scene& scene, unsigned digits) {
  return std::make_unique<CertifierIn<M>>(scene, digits);
}

}  // namespace cradle::tools
