// The checker of core/certify beside a run, in one kind of balls. Compiled once per kind (tools/CMakeLists.txt).
#pragma once

#include <fmt/format.h>

#include <utility>

#include "cradle/core/certify/checker.hpp"
#include "cradle/precision/ball_text.hpp"
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

 public:
  CertifierIn(const Scene& scene, unsigned digits)
      : start_(number<N>(scene.run.start)), end_(scene.run.until.value), law_(certain_law<N>(scene)),
        counted_(!law_.elastic), checker_(initial_bodies<N>(scene), law_) {
    certificate_.digits = digits;
    certificate_.digits_text = digits == 31 ? "double-double" : fmt::format("mpfr, {} digits", digits);
    start_energy_ = to_double(checker_.state_at(N(0)).energy);
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
    const bool last = look.at_contact || !(look.time < end_);
    const N time = number<N>(Decimal(look.time_text)) - start_;
    const CertainState<N> state = look.at_contact ? checker_.state_now() : checker_.state_at(time);
    if (last && counted_ && !state.doubt) compare_counts(look.counts, look.time);
    if (last && !state.doubt) compare_energy(look, state.energy);
    if (state.doubt) {
      // A contact just at the time of a sample leaves that open, not what comes after.
      if (!last) return;
      certificate_.doubt = told(*state.doubt, look.time);
    }
    if (certificate_.doubt) throw ProofEnds();
    add_sample(look, state);
    if (look.of_snapshots) add_snapshot(time, look.time);
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

  // What the engine says that it has done at its contacts.
  void compare_counts(const Counts& counts, double time) {
    const auto& proved = checker_.proved();
    const auto check = [&](std::uint64_t of_engine, std::uint64_t of_proof) {
      if (of_engine == of_proof || certificate_.doubt) return;
      certificate_.doubt = ToldDoubt{Check::counts,
                                     true,
                                     -1,
                                     -1,
                                     time,
                                     proved.contacts,
                                     fmt::format("{}", of_engine),
                                     fmt::format("{}", of_proof)};
    };
    check(counts.contacts, proved.contacts);
    check(counts.merges, proved.merges);
    check(counts.below_cutoff, proved.below_cutoff);
  }
  // A contact on the wrong side of a threshold need not change the sequence. What rounding may have done to the energy
  // in a run of doubles, or of any wider type, is less than this (core/observe/guards.hpp).
  void compare_energy(const RunLook& look, const N& energy) {
    const N told = number<N>(Decimal(look.energy)), off = told - energy;
    const double contacts = static_cast<double>(checker_.proved().contacts) + 64;
    const double bound = 0x1p-49 * contacts * start_energy_;
    if (std::abs(to_double(off)) <= bound || certificate_.doubt) return;
    certificate_.doubt = ToldDoubt{Check::counts, true,           -1,   -1, look.time, checker_.proved().contacts,
                                   look.energy,   middle(energy), bound};
  }

  void add_sample(const RunLook& look, const CertainState<N>& state) {
    CertainSample sample{look.time,
                         look.time_text,
                         look.of_series || look.at_contact,
                         checker_.proved().contacts,
                         enclosed(state.energy),
                         {},
                         {},
                         state.widest,
                         state.least_gap,
                         state.widest_of_gap};
    if (state.front_left) sample.front_left = enclosed(*state.front_left);
    if (state.front_right) sample.front_right = enclosed(*state.front_right);
    certificate_.samples.push_back(std::move(sample));
  }

  void add_snapshot(const N& time, double of_run) {
    const std::size_t number = certificate_.snapshots.size() / 2;
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
  double end_, start_energy_ = 0;
  CertainLaw<N> law_;
  bool counted_;
  Checker<N> checker_;
  Certificate certificate_;
};

template <class M> std::unique_ptr<Certifier> certifier_in(const Scene& scene, unsigned digits) {
  return std::make_unique<CertifierIn<M>>(scene, digits);
}

}  // namespace cradle::tools
