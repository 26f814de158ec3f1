// Compiled separately from the measuring loops: inlined into them, its speed would depend on the surrounding code.
#include "time_slots.hpp"

#include <algorithm>
#include <bit>

namespace twins {

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

}  // namespace twins
