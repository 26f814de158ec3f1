// Compiled separately from the measuring loops: inlined into them, its speed would depend on the surrounding code.
#include "engines.hpp"

#include <bit>
#include <cmath>

namespace twins {

template <class Queue> void QueueEngine<Queue>::advance(double until) {
  while (queue_.first().time <= until) {
    const auto [time, i] = queue_.first();
    line_.collide(i, time);
    ++collisions_;
    queue_.update(i, never);
    if (i > 0) queue_.update(i - 1, line_.due(i - 1, time));
    if (i + 1 < line_.gaps()) queue_.update(i + 1, line_.due(i + 1, time));
  }
}
template class QueueEngine<Scan>;
template class QueueEngine<IndexedHeap>;
template class QueueEngine<TunedHeap>;

// ---- time slots

constexpr double collisions_per_slot = 2;

TimeSlotsEngine::TimeSlotsEngine(const cradle::Particles<double>& particles, Law law) : law_(law) {
  const cradle::ParticleIndex count = particles.count() - 1;
  gaps_.reserve(static_cast<std::size_t>(count));
  std::vector<double> due;
  for (cradle::ParticleIndex b = 0; b < count; ++b) {
    Gap gap{particles.gap(b), particles.closing_speed(b), 0};
    if (gap.closing > 0) gap.due = gap.gap / gap.closing;
    if (gap.due < never) due.push_back(gap.due);
    gaps_.push_back(gap);
  }
  slots_.assign(std::bit_ceil(gaps_.size()), nobody);
  // The initial pace of collisions, from the predicted ones.
  if (const std::size_t some = std::min<std::size_t>(due.size(), 1000); some > 0) {
    const auto last = due.begin() + static_cast<std::ptrdiff_t>(some - 1);
    std::nth_element(due.begin(), last, due.end());
    if (*last > 0) slots_per_time_ = static_cast<double>(some) / *last / collisions_per_slot;
  }
  for (std::uint32_t i = 0; i < gaps_.size(); ++i) enter(i);
  next_fit_ = 64;
}

void TimeSlotsEngine::enter(std::uint32_t i) {
  Gap& gap = gaps_[i];
  if (!(gap.due < never)) {
    gap.slot = nowhere;
    return;
  }
  constexpr double furthest = 0x1p62;
  gap.slot = std::max(now_, static_cast<std::uint64_t>(std::min(gap.due * slots_per_time_, furthest)));
  std::uint32_t& head = slots_[gap.slot & (slots_.size() - 1)];
  gap.next = head;
  gap.previous = nobody;
  if (head != nobody) gaps_[head].previous = i;
  head = i;
  ++entered_;
}

void TimeSlotsEngine::leave(std::uint32_t i) {
  const Gap& gap = gaps_[i];
  if (gap.slot == nowhere) return;
  if (gap.next != nobody) gaps_[gap.next].previous = gap.previous;
  if (gap.previous != nobody)
    gaps_[gap.previous].next = gap.next;
  else
    slots_[gap.slot & (slots_.size() - 1)] = gap.next;
  --entered_;
}

std::uint32_t TimeSlotsEngine::first() {
  if (entered_ == 0) return nobody;
  for (;; ++now_) {
    std::uint32_t best = nobody;
    double soonest = never;
    for (std::uint32_t i = slots_[now_ & (slots_.size() - 1)]; i != nobody; i = gaps_[i].next)
      if (gaps_[i].slot == now_ && (gaps_[i].due < soonest || (gaps_[i].due == soonest && i < best))) {
        soonest = gaps_[i].due;
        best = i;
      }
    if (best != nobody) return best;
  }
}

void TimeSlotsEngine::predict(std::uint32_t i) {
  Gap& gap = gaps_[i];
  leave(i);
  gap.due = gap.closing > 0 ? gap.time + std::max(gap.gap, 0.0) / gap.closing : never;
  enter(i);
}

void TimeSlotsEngine::kick(std::uint32_t i, double gain, double time) {
  Gap& gap = gaps_[i];
  gap.gap -= gap.closing * (time - gap.time);
  gap.time = time;
  gap.closing += gain;
  predict(i);
}

// Fits the width of the slots to the number of collisions since the last call.
void TimeSlotsEngine::fit(double time) {
  const double pace = static_cast<double>(collisions_ - fitted_at_) / (time - fitted_time_);
  next_fit_ =
      collisions_ + std::clamp<std::uint64_t>(collisions_ / 4, 64, 64 + gaps_.size() / 8);  // the pace rises at first
  if (!(time > fitted_time_)) return;
  fitted_at_ = collisions_;
  fitted_time_ = time;
  const double wanted = pace / collisions_per_slot;
  if (wanted < 1.3 * slots_per_time_ && wanted > slots_per_time_ / 1.3) return;
  slots_per_time_ = wanted;
  now_ = static_cast<std::uint64_t>(time * slots_per_time_);
  std::fill(slots_.begin(), slots_.end(), nobody);
  entered_ = 0;
  for (std::uint32_t i = 0; i < gaps_.size(); ++i) enter(i);
}

void TimeSlotsEngine::advance(double until) {
  for (std::uint32_t i = first(); i != nobody && gaps_[i].due <= until; i = first()) {
    Gap& gap = gaps_[i];
    const double time = gap.due, closing = gap.closing;
    const double impulse = (1 + (closing < law_.cutoff ? 1 : law_.restitution)) / 2 * closing;
    gap.gap = 0;
    gap.time = time;
    gap.closing = closing - 2 * impulse;
    predict(i);
    if (i > 0) kick(i - 1, impulse, time);
    if (i + 1 < gaps_.size()) kick(i + 1, impulse, time);
    if (++collisions_ >= next_fit_) fit(time);
  }
}

// ---- particles that merge or pass through each other

constexpr auto none = std::numeric_limits<std::uint32_t>::max();

MergingEngine::MergingEngine(const cradle::Particles<double>& particles, double loss)
    : loss_(loss), circumference_(particles.circumference()), heap_({}) {
  const auto count = static_cast<std::uint32_t>(particles.count());
  for (std::uint32_t b = 0; b < count; ++b)
    particles_.push_back({{particles.position(b), particles.velocity(b), 0}, particles.mass(b), b - 1, b + 1});
  particles_.front().left = circumference_ > 0 ? count - 1 : none;
  particles_.back().right = circumference_ > 0 ? 0 : none;
  std::vector<double> times;
  for (std::uint32_t b = 0; b < count; ++b) times.push_back(due(b, 0));
  heap_ = IndexedHeap(std::move(times));
}

double MergingEngine::due(std::uint32_t i, double now) const {
  const Particle& left = particles_[i];
  if (left.right == none || left.right == i) return never;
  const Particle& right = particles_[left.right];
  const double closing = left.v - right.v;
  if (!(closing > 0)) return never;
  const double around = left.right < i ? circumference_ : 0;
  return now + std::max(right.at(now) + around - left.at(now), 0.0) / closing;
}

void MergingEngine::advance(double until) {
  for (;;) {
    const auto [time, i] = heap_.first();
    if (time > until) return;
    Particle& left = particles_[i];
    const std::uint32_t j = left.right;
    Particle& right = particles_[j];
    left.advance(time);
    right.advance(time);
    ++collisions_;
    const double closing = left.v - right.v, reduced = left.m * right.m / (left.m + right.m);
    const double centre = (left.m * left.v + right.m * right.v) / (left.m + right.m);
    if (reduced * closing * closing / 2 > loss_ && loss_ >= 0) {
      const double after = std::sqrt(closing * closing - 2 * loss_ / reduced);
      std::swap(left.m, right.m);
      left.v = centre - after * right.m / (left.m + right.m);
      right.v = centre + after * left.m / (left.m + right.m);
      heap_.update(j, due(j, time));
      heap_.update(i, due(i, time));
    } else {
      left.v = centre;
      left.m += right.m;
      left.right = right.right;
      if (left.right != none) particles_[left.right].left = i;
      heap_.update(j, never);
      heap_.update(i, due(i, time));
    }
    if (left.left != none) heap_.update(left.left, due(left.left, time));
  }
}

}  // namespace twins
