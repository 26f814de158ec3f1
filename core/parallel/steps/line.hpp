#pragma once
// The arrays on which steps work (steps.hpp): gaps of a segment's copy from 0 to gaps - 1, one array for each of their
// numbers, so that vectors of neighbours are loaded at once. Beyond both ends stand gaps that never close, more than
// a vector and the radius of a decision reach; a tile of gaps has a lower bound of their times of collision.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

namespace cradle {

class StepLine {
 public:
  static constexpr std::size_t tile = 32;
  static constexpr double never = std::numeric_limits<double>::infinity();

  double *gap = nullptr, *closing = nullptr, *time = nullptr, *due = nullptr;  // as in timed_gaps.hpp
  double* lag = nullptr;
  double *fraction = nullptr, *reduced = nullptr;  // unequal masses: see StepTask::unequal
  double* bound = nullptr;                         // of tiles: none of their gaps is due before
  bool lags = false;                               // whether any lag is not 0

  // Gaps whose collisions are made as vectors; those at others are left to StepScalars.
  std::uint32_t inner_first = 0, inner = 0;

  // ---- lists of a step
  std::vector<std::uint32_t> candidates, waiting, first, edges;
  std::vector<double> struck, struck_mass, to_left, to_right, after;

  std::size_t gaps() const { return gaps_; }
  std::size_t tiles() const { return (gaps_ + tile - 1) / tile; }

  void resize(std::size_t gaps) {
    gaps_ = gaps;
    stride_ = (gaps + tile - 1) / tile * tile + 2 * tile;
    const std::size_t needed = 8 * stride_ + alignment;
    if (numbers_.size() < needed) numbers_.resize(needed + needed / 4);
    const auto misplaced = reinterpret_cast<std::uintptr_t>(numbers_.data()) / sizeof(double) % alignment;
    double* array = numbers_.data() + (alignment - misplaced) % alignment + tile;
    for (double** one : {&gap, &closing, &time, &due, &lag, &bound, &fraction, &reduced})
      *one = array, array += stride_;
    std::fill(due - tile, due, never);
    std::fill(due + gaps, due + gaps + tile + (tile - gaps % tile) % tile, never);
    std::fill(bound, bound + tiles() + tile, never);
    for (double* one : {gap, closing, time, lag})
      for (std::size_t k = 0; k < 2; ++k) one[-1 - static_cast<std::ptrdiff_t>(k)] = one[gaps + k] = 0;
    if (guarded_.size() < tiles()) {
      guarded_.resize(tiles()), kept_at_.resize(tiles());
      kept_.resize(kept_size * tiles());
    }
    if (first.size() < gaps + tile) {
      for (auto* list : {&candidates, &waiting}) list->resize(3 * gaps + tile);
      for (auto* list : {&first, &edges}) list->resize(gaps + tile);
      for (auto* list : {&struck, &struck_mass, &to_left, &to_right, &after}) list->resize(gaps + tile);
    }
  }

  void bound_tiles() {
    for (std::size_t k = 0; k < tiles(); ++k) bound[k] = *std::min_element(due + tile * k, due + tile * (k + 1));
  }
  double least_due() const { return *std::min_element(bound, bound + tiles()); }

  // ---- an undo copy of what collisions change from now on, tile by tile as they come near
  void keep() {
    if (lags) lags = std::any_of(lag, lag + gaps_, [](double x) { return x != 0; });
    ++stretch_;
    kept_tiles_.clear();
  }
  // Collisions of gaps of this tile are to come: they and what they set off in a step stay within the tiles beside it.
  void guard(std::size_t k) {
    if (guarded_[k] == stretch_) return;
    guarded_[k] = stretch_;
    for (std::size_t beside = k > 0 ? k - 1 : 0; beside <= k + 1 && beside < tiles(); ++beside)
      if (kept_at_[beside] != stretch_) keep_tile(beside);
  }
  void restore() {
    const double* from = kept_.data();
    for (const std::uint32_t k : kept_tiles_) {
      for (double* array : {gap, closing, time, due, lag}) from = copy(from, array + tile * k);
      bound[k] = *from++;
    }
  }

 private:
  static constexpr std::size_t alignment = 8;  // in doubles: a cache line

  static constexpr std::size_t kept_size = 5 * tile + 1;

  void keep_tile(std::size_t k) {
    kept_at_[k] = stretch_;
    double* to = kept_.data() + kept_size * kept_tiles_.size();
    kept_tiles_.push_back(static_cast<std::uint32_t>(k));
    for (const double* array : {gap, closing, time, due, lag}) to = std::copy_n(array + tile * k, tile, to);
    *to = bound[k];
  }
  static const double* copy(const double* from, double* to) {
    std::copy_n(from, tile, to);
    return from + tile;
  }

  std::size_t gaps_ = 0, stride_ = 0;
  std::vector<double> numbers_;
  std::uint64_t stretch_ = 0;                     // number of the undo copy
  std::vector<std::uint64_t> guarded_, kept_at_;  // the last one that a tile was guarded for, and kept in
  std::vector<double> kept_;
  std::vector<std::uint32_t> kept_tiles_;
};

}  // namespace cradle
