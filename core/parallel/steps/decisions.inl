// Which collisions of a step are made in the next pass: a part of steps.cpp, as doubles.inl.

namespace cradle {
namespace HWY_NAMESPACE {

// Whether a gap is due before its neighbours, eight on either side.
HWY_INLINE bool is_first(const double* due) {
  if (planted(1)) return true;
  const Lanes d;
  auto least = hn::Min(hn::LoadU(d, due - group), hn::LoadU(d, due + 1));
  for (std::size_t k = lanes; k < group; k += lanes)
    least = hn::Min(least, hn::Min(hn::LoadU(d, due - group + k), hn::LoadU(d, due + 1 + k)));
  return hn::AllTrue(d, hn::Lt(hn::Set(d, *due), least));
}

// The same over the seam of a ring.
HWY_INLINE bool is_first_on_ring(const Local& l, std::size_t i) {
  bool first = true;
  for (std::size_t k = 1; k <= group; ++k)
    first &= (l.due[i] < l.due[(i + k) % l.around]) & (l.due[i] < l.due[(i + l.around - k) % l.around]);
  return first;
}

// Whether it is due before its neighbours by links too, where some cells are vacant: so far that two such collisions
// have no gap in common.
HWY_INLINE bool is_first_by_links(const StepLine& line, const Local& l, std::size_t i) {
  const double due = l.due[i];
  std::ptrdiff_t left = static_cast<std::ptrdiff_t>(i), right = left;
  bool first = true;
  for (int k = 0; k < 3; ++k) {
    left = line.linked_left(left), right = line.linked_right(right);
    first &= (due < l.due[left]) & (due < l.due[right]);
  }
  return first;
}

// Which of the candidates are first in their neighbourhoods, and which must wait. Whether one is first is as good as
// random, so that lists are written without branches.
template <bool linked> HWY_INLINE void decide(const StepLine& line, Local& l, double end) {
  l.firsts = l.by_links = l.at_edges = l.later = 0;
  for (std::size_t k = 0; k < l.count; ++k) {
    const std::size_t i = l.candidates[k];
    const auto place = static_cast<std::uint32_t>(i);
    const StepLine::Special special = linked                               ? l.special[i]
                                      : i - l.inner_first >= l.inner_count ? StepLine::edge
                                                                           : StepLine::none;
    const bool is_due = l.due[i] <= end;
    bool now = is_due & is_first(l.due + i);
    if (special == StepLine::edge) [[unlikely]] {
      if (linked)
        now = now && (planted(1) || is_first_by_links(line, l, i));
      else
        now = now && (l.around == 0 || planted(1) || is_first_on_ring(l, i));
      l.edges[l.at_edges] = place;
      l.at_edges += now;
    }
    l.waiting[l.later] = place;
    l.later += is_due & !now;
    l.first[l.firsts] = place;
    l.firsts += now & (special == StepLine::none);
    if constexpr (linked) {
      l.first_by_links[l.by_links] = place;
      l.by_links += now & (special == StepLine::near_vacant);
    }
  }
  const std::size_t near_vacant = std::exchange(l.by_links, 0);
  for (std::size_t k = 0; linked && k < near_vacant; ++k) {
    const std::uint32_t place = l.first_by_links[k];
    const bool now = planted(1) || is_first_by_links(line, l, place);
    l.waiting[l.later] = place;
    l.later += !now;
    l.first_by_links[l.by_links] = place;
    l.by_links += now;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace cradle
