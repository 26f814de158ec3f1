#pragma once
// One run in segments. A segment is a part of the line that is computed alone for a time slab, a short interval of
// time. Several threads take one segment each; a single thread takes one after the other, so that each stays in the
// caches of the processor. The result is that of the plain loop, bit for bit.
//
// Why the result is exact. A collision at the gap i reads and changes the gaps i - 1, i and i + 1, and every gap has a
// local time of its own: what becomes of a gap depends on the collisions at it and beside it, in their order, and on
// nothing else. A segment owns the gaps from one cut to the next. It works on a copy of these and of some gaps of its
// neighbours on either side, the ghosts, as they were when the time slab began. Gaps beyond the ghosts are missing; the
// errors that follow move inwards by at most one gap per collision. At each cut both sides log the collisions at the
// last gap before the cut and at the first gap behind it: which of the two gaps it is, the exact time and the closing
// speed.
//
//   If both logs of every cut are the same, the owned gaps of all segments together are those of the plain loop.
//
// Assume that both sides make their collisions in increasing order of (exact time, position); the last paragraph says
// how this is ensured. Assume also that all collisions which the plain loop has made so far are those of the segments.
// The plain loop then takes the first pending collision, K. Let A be the segment that owns its gap. So far all gaps
// that A owns, and the first gap behind each of its cuts, have had the same collisions in A as in the plain loop. So K
// is pending in A too, and it is the next collision that A makes at a gap that it owns, unless A first makes a
// collision L at the gap behind a cut. L is in A's log. Since the logs agree, L is also the next collision there of the
// segment B on the other side, at an earlier time than that of K. B makes its collisions in order, so L is already
// pending in B and hence in the plain loop, which would have taken L and not K. So the plain loop takes the collisions
// of the segments, up to the end of the time slab.
//
// A time slab is given up, and the plain loop makes the next collisions, if collisions are out of order (a gap is below
// zero), the origin must move, a gap falls below the gap floor, or a segment cannot go on (a front needs more particles
// than were copied, say). Where the two logs of a cut differ, the segments beside it are joined and computed again;
// this is repeated until all logs agree. The lengths of time slabs, the places of cuts and the number of ghosts are
// chosen for speed alone; none of this shows in the result.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/parallel/cluster_segment.hpp"
#include "cradle/core/parallel/gap_segment.hpp"
#include "cradle/core/parallel/steps/stepped.hpp"
#include "cradle/core/parallel/steps/stepped_clusters.hpp"
#include "cradle/core/parallel/workers.hpp"

namespace cradle {

// How segments are made. These choices affect how long a run takes, never its result.
struct Segmentation {
  std::size_t gaps = 0;          // about as many are owned by a segment; 0: a number is chosen
  std::size_t ghosts = 64;       // on either side
  double collisions = 0;         // per gap in a time slab; 0: a number is chosen
  bool anywhere = false;         // whether segments are made even where the plain loop is quicker
  const Steps* steps = nullptr;  // fastest_steps() where that is linked (steps/steps.hpp); null: none
};

// Goes through time slabs in segments.
template <class Law, class Chain>
requires(!LawWithMemory<Law, typename Chain::Scalar>) class Segments {
 public:
  using T = typename Chain::Scalar;

  explicit Segments(Workers workers = {}, Segmentation how = {})
      : workers_(std::move(workers)), how_(how), segments_(workers_.count) {
    if (how_.gaps == 0) how_.gaps = in_steps() ? 6000 : 2800;
    how_.ghosts = std::max<std::size_t>(how_.ghosts, 1);  // a cut has a gap on either side
  }

  // What a time slab has made.
  struct TimeSlab {
    Counts counts;
    T last_collision{0};
  };

  struct Statistics {
    std::uint64_t slabs = 0, given_up = 0;  // made in segments; begun so, and left to the plain loop
    std::uint64_t collisions = 0;           // in the former
    std::uint64_t in_steps = 0;             // of these
    std::uint64_t again = 0;                // collisions of joined segments
    std::uint64_t largest = 0;              // collisions of the largest segment of each time slab, summed up
  };
  const Statistics& statistics() const { return statistics_; }

  // The number of collisions to be made in the plain loop before the next time slab, if about so many are to come
  // before the run stops or the epoch ends; 0 if there are to be no time slabs.
  std::uint64_t plain_collisions(const Chain& chain, double ahead) {
    const std::size_t held = chain.last() + 1 - chain.first();
    if (!(ahead > 0)) return 64;
    const std::size_t middle = (chain.first() + chain.last()) / 2;
    if (!chain.fronts_are_within(middle, middle) || segments(chain, held) == 0) return 256;
    // A time slab visits every gap.
    if (!how_.anywhere && ahead < static_cast<double>(held) / 8) return held / 64 + 1;
    return std::exchange(plain_, 0);
  }
  // Where the next time slab should end, with so many collisions ahead up to `stop`. Those that are observed are held
  // in memory.
  T end(const Chain& chain, const T& from, const T& stop, double ahead, bool observed) const {
    const auto held = static_cast<double>(chain.last() + 1 - chain.first());
    const double most = observed ? std::max(held, least_observed) : std::numeric_limits<double>::infinity();
    const double slabs = std::ceil(ahead / std::min(per_gap_ * held, most));
    if (!(slabs > 1)) return stop;
    return from + (stop - from) / T(static_cast<std::int64_t>(std::min(slabs, 0x1p40)));
  }

  using Part = typename Segment<Law, Chain>::Part;
  // An observer is given all collisions of a time slab, in the order of the plain loop, before the chain is what they
  // make of it. If it throws, the chain stays as it was.
  using Observer = std::function<void(const std::vector<typename Part::Observed>&)>;

  // Makes all collisions up to the local time `stop`, fewer than `most` of them; nothing where that is for the plain
  // loop. `observer` may be empty.
  std::optional<TimeSlab> make(Chain& chain, const Law& law, const T& stop, std::uint64_t most,
                               const Observer& observer) {
    if (chain.cramped(how_.ghosts)) {
      chain.make_room();
      weights_.clear();
    }
    cut(chain);
    if (!chain.fronts_are_within(own_.front().first + own_.front().gaps - 1, own_.back().first)) return give_up(chain);
    if (!after_) after_.emplace(chain.start(), T(1));
    const bool fewer = after_->slots() > chain.slots();
    after_->resize(chain.slots());
    for (Slot s = 0; fewer && s < chain.slots(); ++s)
      if (s < chain.first() || s > chain.last()) after_->put(s, {});  // else it would name slots that there are no more
    std::vector<std::size_t> todo(own_.size());
    std::iota(todo.begin(), todo.end(), std::size_t{0});
    std::uint64_t again = 0, all = 0;
    for (bool first = true; !todo.empty(); first = false) {
      workers_.run(todo.size(), [&](std::size_t job, std::size_t worker) {
        if (!segments_[worker]) segments_[worker] = std::make_unique<Segment<Law, Chain>>(chain);
        Report& report = reports_[todo[job]];
        report.observe = static_cast<bool>(observer);
        segments_[worker]->run(chain, law, own_[todo[job]], how_.ghosts, stop, most, how_.steps, *after_, report);
      });
      for (const std::size_t k : todo) {
        if (reports_[k].plain) return give_up(chain);
        (first ? all : again) += reports_[k].counts.collisions;
      }
      todo = join(chain);
      // Steps are quicker than the plain loop on a whole line too.
      if (own_.size() < 2 && !todo.empty() && (!in_steps() || chain.on_ring())) return give_up(chain);
    }
    TimeSlab slab;
    std::uint64_t largest = 0;
    bool first = true;
    for (const Report& report : reports_) {
      largest = std::max(largest, report.counts.collisions);
      slab.counts += report.counts;
      if (report.counts.collisions > 0 && (first || slab.last_collision < report.last_collision)) {
        slab.last_collision = report.last_collision;
        first = false;
      }
    }
    if (slab.counts.collisions >= most || !Part::fit(reports_)) return give_up(chain);
    if (observer) observer(in_order_.of(reports_));
    Part::continue_with(chain, *after_, reports_);
    for (const Report& report : reports_) chain.lose(report.lost);
    statistics_.slabs += 1;
    statistics_.collisions += slab.counts.collisions;
    for (const Report& report : reports_)
      if (report.in_steps) statistics_.in_steps += report.counts.collisions;
    statistics_.again += again;
    statistics_.largest += largest;
    adapt(chain, static_cast<double>(again) / static_cast<double>(all + 1));
    return slab;
  }

 private:
  using Report = typename Segment<Law, Chain>::Report;
  bool in_steps() const { return how_.steps != nullptr && Stepped<Law, Part>::possible; }
  static constexpr double least_per_gap = 1. / 8;
  static constexpr std::size_t least_on_ring = 100;  // gaps, for steps on a ring without cuts to pay
  static constexpr double least_observed = 1 << 14;  // collisions in a time slab, if there are as many

  std::optional<TimeSlab> give_up(const Chain& chain) {
    const std::size_t held = chain.last() + 1 - chain.first();
    ++statistics_.given_up;
    failed_ = true;
    patience_ = std::min<std::size_t>(2 * patience_ + 1, 63);
    plain_ = patience_ * held;
    per_gap_ = std::max(per_gap_ / 2, least_per_gap);
    return {};
  }
  void adapt(const Chain& chain, double again) {
    patience_ /= 2;
    failed_ = failed_ || again > 0;
    per_gap_ *= again > 0 ? std::max(0.5, 1 - 10 * again) : failed_ ? 1.01 : 1.3;
    per_gap_ = std::min(std::max(per_gap_, least_per_gap), how_.collisions > 0 ? how_.collisions : 8);
    weights_.clear();
    for (std::size_t k = 0; k < own_.size(); ++k)
      weights_.push_back({chain.place(own_[k].first), own_[k].gaps, reports_[k].counts.collisions});
  }

  // How many segments are made of so many gaps: as many for each thread. A ring has no cut or at least two; 0 says that
  // it is too small for them.
  std::size_t segments(const Chain& chain, std::size_t held) const {
    const std::size_t threads =
        how_.anywhere ? workers_.count : std::max<std::size_t>(1, std::min(workers_.count, held / gaps_per_thread));
    const std::size_t each = (held + threads * how_.gaps / 2) / (threads * how_.gaps);
    const std::size_t count = std::min(threads * std::max<std::size_t>(each, 1), held / 2);
    if (count > 1 || !chain.on_ring()) return std::max<std::size_t>(count, 1);
    if (in_steps() && Stepped<Law, Part>::on_rings && held >= least_on_ring) return 1;
    return held >= 2 * gaps_per_thread ? 2 : 0;
  }

  // Cuts the line into segments of about as many collisions each, by those of the time slab before; gaps count for a
  // quarter of a mean gap's collisions, so that no segment gets too long.
  void cut(const Chain& chain) {
    const std::size_t held = chain.last() + 1 - chain.first();
    const std::size_t count = segments(chain, held);
    own_.clear();
    double collisions = 0;
    for (const Weight& weight : weights_) collisions += static_cast<double>(weight.collisions);
    if (!(collisions > 0)) weights_.clear();
    // Weight of a gap: 1 where nothing is known.
    const double per_collision = 0.8 * static_cast<double>(held) / collisions;
    const double share = 1. / static_cast<double>(count);
    Slot from = chain.first(), slot = from;
    double passed = 0;                                 // of the whole weight, up to `slot`
    const auto extend = [&](Slot to, double weight) {  // gaps up to `to` have so much of it each
      while (slot < to && own_.size() + 1 < count) {
        const double wanted = (share * static_cast<double>(own_.size() + 1) - passed) / weight;
        const auto gaps = static_cast<std::size_t>(std::max(1., std::ceil(wanted)));
        if (slot + gaps > to) break;
        slot += gaps;
        passed += static_cast<double>(gaps) * weight;
        own_.push_back({from, slot - from});
        from = slot;
      }
      if (slot < to) passed += static_cast<double>(to - slot) * weight, slot = to;
    };
    const double gap = 1. / static_cast<double>(held);
    for (const Weight& weight : weights_) {
      const ParticleIndex begin = std::max(weight.place, chain.place(chain.first()));
      const ParticleIndex end =
          std::min(weight.place + static_cast<ParticleIndex>(weight.gaps), chain.place(chain.last()) + 1);
      if (end <= begin || chain.place(slot) > begin) continue;
      const Slot at = chain.first() + static_cast<Slot>(begin - chain.place(chain.first()));
      extend(at, gap);
      extend(at + static_cast<Slot>(end - begin),
             gap * (0.2 + per_collision * static_cast<double>(weight.collisions) / static_cast<double>(weight.gaps)));
    }
    extend(chain.last() + 1, gap);
    own_.push_back({from, chain.last() + 1 - from});
    reports_.resize(own_.size());
  }

  // Joins segments whose logs differ, and says which are to be made again; the only one where no cut is left.
  std::vector<std::size_t> join(const Chain& chain) {
    const std::size_t count = own_.size();
    std::vector<char> kept(count);  // the cut on the left of each
    for (std::size_t k = 0; k < count; ++k) {
      const Report &left = reports_[(k + count - 1) % count], &right = reports_[k];
      kept[k] = (k == 0 && (!chain.on_ring() || count == 1)) ||
                (!left.nothing_left && !right.nothing_left && left.right == right.left);
    }
    // On a ring begin behind a cut that is kept.
    const auto begin = static_cast<std::size_t>(std::find(kept.begin(), kept.end(), 1) - kept.begin());
    if (begin == count) return own_.resize(1), std::vector<std::size_t>{0};
    std::vector<std::size_t> again;
    std::vector<OwnedGaps> own;
    std::vector<Report> reports;
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t k = (begin + j) % count;
      if (kept[k]) {
        own.push_back(own_[k]);
        reports.push_back(std::move(reports_[k]));
      } else {
        own.back().gaps += own_[k].gaps;
        if (again.empty() || again.back() + 1 != own.size()) again.push_back(own.size() - 1);
      }
    }
    own_ = std::move(own);
    reports_ = std::move(reports);
    return again;
  }

  Workers workers_;
  Segmentation how_;
  Statistics statistics_;
  double per_gap_ = 4;   // collisions that a time slab is to have
  bool failed_ = false;  // whether a cut ever has
  std::size_t patience_ = 0;
  std::uint64_t plain_ = 0;  // collisions
  struct Weight {
    ParticleIndex place;  // of the first gap
    std::size_t gaps;
    std::uint64_t collisions;
  };
  std::vector<Weight> weights_;                                 // of the last time slab
  std::vector<std::unique_ptr<Segment<Law, Chain>>> segments_;  // one for each worker
  std::vector<OwnedGaps> own_;
  std::vector<Report> reports_;
  std::optional<typename Chain::Line::Gaps> after_;  // the chain's gaps after the time slab
  ObservedInOrder<typename Part::Observed> in_order_;
};

}  // namespace cradle
