#include "cradle/tools/proof/certify.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/tools/ensemble/layout.hpp"
#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/record/schedule.hpp"

namespace cradle::tools {

namespace {

CertifiedReplica kept(std::uint64_t index, const Certified& run, const std::vector<double>& times) {
  const Certificate& c = run.certificate;
  CertifiedReplica kept{
      index, run.proved(), c.digits, c.collisions, {0, 0}, run.undecided(), std::vector<double>(times.size(), none())};
  if (!c.samples.empty()) kept.energy = c.samples.back().energy.doubles;
  for (const CertainSample& s : c.samples) {
    const auto at = std::lower_bound(times.begin(), times.end(), s.time);
    if (!s.of_series || at == times.end() || *at != s.time) continue;
    const double energy = s.energy.doubles.low + (s.energy.doubles.high - s.energy.doubles.low) / 2;
    kept.energies[static_cast<std::size_t>(at - times.begin())] = energy;
  }
  return kept;
}

std::uint64_t proved_of(const CertifiedReplicas& run) {
  return static_cast<std::uint64_t>(std::ranges::count(run.replicas, true, &CertifiedReplica::proved));
}

}  // namespace

CertifiedReplicas certify_replicas(const Scene& scene, std::uint64_t count, unsigned threads,
                                   const CertifyOptions& options) {
  check_ensemble(scene);
  CertifiedReplicas result{scene, std::vector<CertifiedReplica>(count), Schedule(scene).series().rounded(), {}};
  std::vector<CertifiedReplica>& all = result.replicas;
  const auto interrupted = [&] { return options.interrupt != nullptr && options.interrupt->signal() != 0; };
  const auto prove = [&](std::uint64_t index, const std::vector<unsigned>& digits) {
    return kept(index, certify(replica_scene(scene, index), {digits, Progress::Show::never, options.interrupt}),
                result.times);
  };
  ReplicaQueue queue({{0, count}});
  run_jobs(
      Threads(threads), [&] { return queue(); },
      [&](std::uint64_t k) {
        try {
          return prove(k, {options.digits.front()});
        } catch (const Error&) {
          if (interrupted()) throw ReplicaAbandoned();
          throw;
        }
      },
      [&](std::uint64_t k, CertifiedReplica replica) { all[k] = std::move(replica); },
      [&](std::uint64_t k, const std::string& message) {
        all[k] = {k, false, 0, 0, {0, 0}, message, {}};
      },
      interrupted);
  if (interrupted())
    throw Error({}, "interrupted", "", "run it again; nothing is kept of proofs, those that finished included",
                status_of_signal(options.interrupt->signal()));
  const std::vector<unsigned> more(options.digits.begin() + 1, options.digits.end());
  Ensemble energies;
  for (CertifiedReplica& replica : all) {
    if (!replica.proved && replica.digits > 0 && !more.empty()) replica = prove(replica.index, more);
    if (replica.proved) energies.add(replica.index, std::move(replica.energies));
  }
  result.energy = energies.statistics();
  return result;
}

std::string replicas_text(const CertifiedReplicas& run) {
  std::uint64_t collisions = 0;
  std::string text;
  for (const CertifiedReplica& r : run.replicas) {
    collisions += r.collisions;
    if (!r.proved) text += fmt::format("replica {}: undecided {}\n", r.index, r.doubt);
  }
  text += fmt::format("proved: {} of {} replicas, {} collisions\n", proved_of(run), run.replicas.size(), collisions);
  for (std::size_t k = run.energy.entries(); k-- > 0;)  // the last time that any has reached
    if (const std::uint64_t n = run.energy.count(k); n > 0) {
      text += fmt::format("  energy at t = {}: {:.12g}", run.times[k], run.energy.mean[k]);
      if (n > 1) text += fmt::format(" +- {:.2g}", run.energy.standard_error(k));
      return text + fmt::format(" (mean{} of the {} that {} proved up to there)\n",
                                n > 1 ? " and its standard error" : "", n, n > 1 ? "are" : "is");
    }
  return text;
}

Result replicas_result(const CertifiedReplicas& run) {
  const auto of_rows = [&](auto of) { return numbers_of(run.replicas, of); };
  const std::uint64_t all = proved_of(run);
  Result result;
  result.attributes = provenance(run.scene, precision_name(run.scene.run),
                                 all == run.replicas.size() ? "replicas with proofs" : end_row(RunEnd::undecided).text);
  result.groups.push_back({"ensemble", {{"replicas", std::uint64_t{run.replicas.size()}}, {"proved", all}}, {}});
  result.groups.push_back({"ensemble/series", {}, {{"time", "t", "of the sample", run.times}}});
  const std::string unit = "m l^2/t^2";
  const Quantity energy{"series", "energy", unit, "kinetic energy, of those that are proved", 0, run.times.size()};
  result.groups.push_back(statistics_group("ensemble/series/energy", energy, run.energy));
  result.groups.push_back({"replicas",
                           {},
                           {{"index", "1", "of the replica", of_rows(&CertifiedReplica::index)},
                            {"proved", "1", "1: to the end; 0: undecided", of_rows(&CertifiedReplica::proved)},
                            {"digits", "1", "of the proof", of_rows(&CertifiedReplica::digits)},
                            {"collisions", "1", "proved", of_rows(&CertifiedReplica::collisions)},
                            {"energy_low", unit, "lower bound of the energy at the last sample that is proved",
                             of_rows([](const CertifiedReplica& row) { return row.energy.low; })},
                            {"energy_high", unit, "upper bound of it",
                             of_rows([](const CertifiedReplica& row) { return row.energy.high; })}}});
  result.groups.back().columns.front().names = true;
  return result;
}

}  // namespace cradle::tools
