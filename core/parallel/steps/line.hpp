#pragma once
// Steps (steps.hpp) work on this line: the gaps of a segment's copy, from 0 to gaps - 1. Beside them stand their times
// of collision once more, one after the other, so that vectors of neighbours are loaded at once. Beyond both ends stand
// gaps that never close, more than a vector and the radius of a decision reach; a tile of gaps has a lower bound of
// their times of collision.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "cradle/core/chains/cluster_line.hpp"
#include "cradle/core/chains/watched_gap.hpp"

namespace cradle {

class StepLine {
 public:
  static constexpr std::size_t tile = 16;
  static constexpr double never = std::numeric_limits<double>::infinity();

  Gap<double>* cells = nullptr;                    // the gaps; they belong to the caller
  Cell<double>* clusters = nullptr;                // or, of particles that may merge, these with the gaps behind them
  double* numbers = nullptr;                       // the first one of either; gap, local time and time due come first
  const double* lag = nullptr;                     // of gaps with a negative local time; the caller's too
  double* due = nullptr;                           // a copy of the cells' `due`
  double* bound = nullptr;                         // for each tile: none of its gaps is due before
  double *fraction = nullptr, *reduced = nullptr;  // unequal masses: see StepTask::unequal

  // Where numbers are sums of two doubles (pairs.inl) there are no cells, but an array for each number's greater and
  // lesser double. `lost` is the energy lost at each gap.
  struct Halves {
    double *gap = nullptr, *closing = nullptr, *time = nullptr, *due = nullptr, *lost = nullptr, *lag = nullptr;
    double *fraction = nullptr, *reduced = nullptr;
  };
  Halves high, low;

  // Gaps whose collisions are made as vectors; those at others are left to StepScalars.
  std::uint32_t inner_first = 0, inner_count = 0;

  // Whether the last gap and the first one are neighbours. Then the gaps within a decision's radius of them are none of
  // the inner ones.
  bool ring = false;
  std::size_t left_of(std::size_t i) const { return i > 0 ? i - 1 : ring ? gaps_ - 1 : 0; }
  std::size_t right_of(std::size_t i) const { return ring && i + 1 == gaps_ ? 0 : i + 1; }

  // Of clusters: neighbours by links, which skip vacant cells (-1 and gaps() are beyond the ends).
  Slot slot_of_first = 0;
  std::ptrdiff_t linked_left(std::ptrdiff_t i) const { return index(clusters[i].left); }
  std::ptrdiff_t linked_right(std::ptrdiff_t i) const { return index(clusters[i].right); }
  std::ptrdiff_t index(Slot s) const {
    return static_cast<std::ptrdiff_t>(s) - static_cast<std::ptrdiff_t>(slot_of_first);
  }
  // What is special about a gap: there is a vacant cell near it; or its collisions are left to StepScalars.
  enum Special : std::uint8_t { none, near_vacant, edge };
  std::vector<Special> special;
  void mark(std::ptrdiff_t from, std::ptrdiff_t to, Special as) {
    const auto begin = std::max<std::ptrdiff_t>(from, 0),
               end = std::min<std::ptrdiff_t>(to + 1, static_cast<std::ptrdiff_t>(gaps_));
    Special* const all = special.data();
    for (std::ptrdiff_t i = begin; i < end; ++i) all[i] = std::max(all[i], as);
  }

  // A step may leave a few gaps that are due to the next one. Those that are due up to `listed_to` are the first `left`
  // candidates.
  bool may_leave = false;
  double listed_to = -never;
  std::size_t left = 0;

  // ---- lists of a step
  std::vector<std::uint32_t> candidates, waiting, first, first_by_links, edges;
  std::vector<std::uint32_t> visited;  // tiles with collisions
  std::vector<double> struck, struck_mass, to_left, to_right, after;
  std::vector<double> low_struck, low_to_left, low_to_right, low_after, work;  // of pairs

  std::size_t gaps() const { return gaps_; }
  std::size_t tiles() const { return (gaps_ + tile - 1) / tile; }

  // Takes so many gaps.
  void take(Gap<double>* first_cell, const double* first_lag, std::size_t gaps) {
    cells = first_cell, clusters = nullptr;
    take(&first_cell->gap, sizeof(Gap<double>), first_lag, gaps);
  }
  void take(Cell<double>* first_cell, Slot slot, const double* first_lag, std::size_t gaps) {
    cells = nullptr, clusters = first_cell, slot_of_first = slot;
    special.assign(gaps, none);
    take(&first_cell->gap, sizeof(Cell<double>), first_lag, gaps);
  }
  // Takes so many gaps, the arrays of which the caller fills.
  void take_pairs(std::size_t gaps) {
    cells = nullptr, clusters = nullptr, numbers = nullptr;
    resize(gaps, true);
  }
  void bound_tiles() {
    for (std::size_t k = 0; k < tiles(); ++k) bound[k] = *std::min_element(due + tile * k, due + tile * (k + 1));
  }
  double least_due() const { return *std::min_element(bound, bound + tiles()); }

  // ---- an undo copy of what collisions change from now on; a tile is copied when collisions come near it
  void keep() {
    ++stretch_;
    kept_tiles_.clear();
  }
  // To be called before collisions at gaps of this tile are made. In fewer passes than a tile has gaps, what they set
  // off stays within the tiles beside it.
  void guard(std::size_t k) {
    if (guarded_[k] == stretch_) return;
    guarded_[k] = stretch_;
    for (std::size_t beside = k > 0 ? k - 1 : 0; beside <= k + 1 && beside < tiles(); ++beside) keep_tile(beside);
    if (!ring) return;
    if (k == 0) keep_tile(tiles() - 1), keep_tile(tiles() - 2);  // the last one may not be full
    if (k + 2 >= tiles()) keep_tile(tiles() - 1), keep_tile(0);
  }
  // The gaps beside one by links, on the line, with the tiles of all that a collision there may change guarded.
  std::pair<std::size_t, std::size_t> guarded_by_links(std::size_t i) {
    const auto guarded = [&](std::ptrdiff_t at) {
      const auto on_line =
          static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(gaps_) - 1));
      guard(on_line / tile);
      return on_line;
    };
    const std::size_t before = guarded(linked_left(static_cast<std::ptrdiff_t>(i))),
                      behind = guarded(linked_right(static_cast<std::ptrdiff_t>(i)));
    guarded(linked_right(static_cast<std::ptrdiff_t>(behind)));
    return {before, behind};
  }
  void restore() {
    listed_to = -never, left = 0;
    const double* from = kept_.data();
    const double* number = kept_numbers_.data();
    for (const std::uint32_t k : kept_tiles_) {
      for (double* array : arrays_) {
        std::copy_n(number, tile, array + tile * k);
        number += tile;
      }
      if (numbers != nullptr) {
        std::memcpy(numbers + width_ * tile * k, from, width_ * in_tile(k) * sizeof(double));
        take_due(tile * k, tile * k + in_tile(k));
        from += width_ * tile;
      }
      bound[k] = *std::min_element(due + tile * k, due + tile * (k + 1));
    }
  }

 private:
  static constexpr std::size_t alignment = 8;  // in doubles: a cache line

  void take(double* first_number, std::size_t size, const double* first_lag, std::size_t gaps) {
    numbers = first_number, width_ = size / sizeof(double), lag = first_lag;
    resize(gaps, false);
    take_due(0, gaps);
    bound_tiles();
  }
  void take_due(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) due[i] = numbers[width_ * i + 2];
  }
  std::size_t in_tile(std::size_t k) const { return std::min(tile, gaps_ - tile * k); }
  void resize(std::size_t gaps, bool pairs) {
    gaps_ = gaps;
    listed_to = -never, left = 0;
    const std::size_t stride = (gaps + tile - 1) / tile * tile + 2 * tile,
                      needed = (pairs ? 17 : 4) * stride + alignment;
    if (numbers_.size() < needed) numbers_.resize(needed + needed / 4);
    const auto misplaced = reinterpret_cast<std::uintptr_t>(numbers_.data()) / sizeof(double) % alignment;
    double* array = numbers_.data() + (alignment - misplaced) % alignment + tile;
    for (double** one : {&due, &bound, &fraction, &reduced}) *one = array, array += stride;
    std::fill(due - tile, due, never);
    std::fill(due + gaps, due + tile * (tiles() + 1), never);
    std::fill(bound, bound + tiles() + tile, never);
    arrays_.clear();
    if (pairs) {
      high.due = due, high.fraction = fraction, high.reduced = reduced;
      arrays_ = {due};
      for (double** one :
           {&high.gap, &high.closing, &high.time, &high.lost, &low.gap, &low.closing, &low.time, &low.due, &low.lost}) {
        *one = array, array += stride;
        arrays_.push_back(*one);
        for (std::size_t k = 0; k < 2; ++k) (*one)[-1 - static_cast<std::ptrdiff_t>(k)] = (*one)[gaps + k] = 0;
      }
      for (double** one : {&high.lag, &low.lag, &low.fraction}) {
        *one = array, array += stride;
        for (std::size_t k = 0; k < 2; ++k) (*one)[-1 - static_cast<std::ptrdiff_t>(k)] = (*one)[gaps + k] = 0;
      }
      low.reduced = array;
      kept_numbers_.resize(std::max(kept_numbers_.size(), arrays_.size() * tile * tiles()));
      for (auto* list : {&low_struck, &low_to_left, &low_to_right, &low_after}) list->resize(gaps + tile);
      work.resize(16 * (gaps + tile));
    }
    if (guarded_.size() < tiles()) guarded_.resize(tiles()), kept_at_.resize(tiles());
    if (kept_.size() < width_ * tile * tiles()) kept_.resize(width_ * tile * tiles());
    if (first.size() < gaps + tile) {
      for (auto* list : {&candidates, &waiting, &visited}) list->resize(3 * gaps + tile);
      for (auto* list : {&first, &first_by_links, &edges}) list->resize(gaps + tile);
      for (auto* list : {&struck, &struck_mass, &to_left, &to_right, &after}) list->resize(gaps + tile);
    }
  }
  void keep_tile(std::size_t k) {
    if (kept_at_[k] == stretch_) return;
    kept_at_[k] = stretch_;
    if (numbers != nullptr)
      std::memcpy(kept_.data() + width_ * tile * kept_tiles_.size(), numbers + width_ * tile * k,
                  width_ * in_tile(k) * sizeof(double));
    double* to = kept_numbers_.data() + arrays_.size() * tile * kept_tiles_.size();
    for (const double* array : arrays_) to = std::copy_n(array + tile * k, tile, to);
    kept_tiles_.push_back(static_cast<std::uint32_t>(k));
  }

  std::size_t gaps_ = 0;
  std::vector<double> numbers_;
  std::uint64_t stretch_ = 0;                     // number of the undo copy
  std::vector<std::uint64_t> guarded_, kept_at_;  // the last one that a tile was guarded for, and kept in
  std::size_t width_ = 0;                         // of a cell, in doubles
  std::vector<double> kept_;                      // cells
  std::vector<double*> arrays_;                   // of pairs: what collisions change
  std::vector<double> kept_numbers_;
  std::vector<std::uint32_t> kept_tiles_;
};

}  // namespace cradle
