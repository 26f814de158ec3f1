// A gas that shares no code with the engine or the checker of proofs, on a line, a ring or between walls: it searches
// all pairs of neighbours for the next collision. A particle's stored position is extrapolated back to time 0, which
// keeps rationals short. In rationals it is exact; scenes with roots use 100 digits. Under gravity this is so in a
// frame that falls; of both times at which a parabola meets a wall, each by the textbook's formula, it takes the first
// that is to come.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"
#include "cradle/precision/bin_float.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test {

using std::exp, std::pow, std::sqrt;  // of long double; those of wider numbers are found by their types
inline Rational sqrt(const Rational&) { throw std::logic_error("a root of a rational"); }  // 100 digits have them
inline Rational exp(const Rational&) { throw std::logic_error("the exponential of a rational"); }
inline Rational pow(const Rational&, const Rational&) { throw std::logic_error("a rational power"); }

enum class GasLaw { inelastic, contact_time, merging, sticky, wet };

// A wall on either side of particles that bounce, with its account; its place is at time 0.
template <class T> struct GasWall {
  T origin, v, restitution;
  std::function<T(std::uint64_t collision, const T& mass)> random_speed{};  // of a thermal wall
  std::uint64_t collisions = 0;
  T given{0}, momentum{0}, lost{0};
};

// Merged particles are one cell; cells are ordered from left to right, on a ring up to the seam.
template <class T> struct Gas {
  struct Cell {
    T origin, v, m;
    std::vector<std::int64_t> particles;
    std::optional<T> touched{};  // the time of its last collision
  };
  std::vector<Cell> cells;
  GasLaw law = GasLaw::inelastic;
  T restitution{1}, cutoff{0}, contact_time{0}, merge_speed{0}, loss{0}, length{0};
  T acceleration{0};                                 // of all particles, between walls; then roots are needed
  T cutoff_exponent{0};                              // above 0: the restitution depends on the speed
  std::array<std::optional<GasWall<T>>, 2> walls{};  // left, right

  T time{0};
  std::uint64_t collisions = 0, below_cutoff = 0, merges = 0;
  std::optional<std::int64_t> latest{};  // the gap that closed last
  bool tied = false;                     // three particles met at one time: the motion after that is undefined,
  bool ties_from_left = false;           // unless such collisions are made from the left

  // Makes all collisions up to a time, or the first `most`.
  void advance(const T& until, std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
    while (collisions < most && next(until)) continue;
    if (collisions < most) time = until;
  }
  // Makes the next collision not after `until`; `wrong_side`: as if it were on the other side of the cut-off.
  std::optional<std::pair<std::int64_t, std::int64_t>> next(const T& until, bool wrong_side = false) {
    if (tied) return std::nullopt;
    std::optional<T> first;
    std::vector<std::int64_t> together;  // gaps, by the cell on their left; -1: the left wall
    const auto may_close = [&](std::int64_t gap, const std::optional<T>& due) {
      if (due && (!first || *due < *first)) first = due, together.clear();
      if (due && *due == *first) together.push_back(gap);
    };
    for (std::size_t k = 0; k < pairs(); ++k)
      may_close(static_cast<std::int64_t>(k),
                closes(cells[after(k)].origin + seam(k) - cells[k].origin, cells[k].v - cells[after(k)].v));
    if (walls[0]) may_close(-1, meets_wall(true));
    if (walls[1]) may_close(last(), meets_wall(false));
    if (!first || *first > until) return std::nullopt;
    time = *first;
    for (const std::int64_t a : together)
      for (const std::int64_t b : together)
        tied = !ties_from_left &&
               (tied || a - b == 1 ||
                (length > 0 && a != b && after(static_cast<std::size_t>(b)) == static_cast<std::size_t>(a)));
    if (tied) return std::nullopt;
    const std::int64_t gap = together.front();
    latest = gap;
    if (gap < 0 || (walls[1] && gap == last())) return strike(gap < 0);
    const auto k = static_cast<std::size_t>(gap);
    const std::pair collision{cells[k].particles.front(), cells[after(k)].particles.front()};
    collide(k, wrong_side);
    return collision;
  }
  T energy() const {
    T twice(0);
    for (const Cell& cell : cells) twice += cell.m * velocity(cell) * velocity(cell);
    return twice / 2;
  }
  const Cell* outermost(bool left) const {
    const Cell* found = nullptr;
    for (const Cell& cell : cells)
      if (cell.touched && !(left && found)) found = &cell;
    return length > 0 ? nullptr : found;
  }
  const Cell& cell_of(std::int64_t particle) const {
    return *std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) {
      return std::find(cell.particles.begin(), cell.particles.end(), particle) != cell.particles.end();
    });
  }
  T place(const Cell& cell) const { return flown(cell) + acceleration * time * time / 2; }
  T velocity(const Cell& cell) const { return cell.v + acceleration * time; }
  T gap_after(std::size_t k) const { return place(cells[after(k)]) - place(cells[k]) + seam(k); }
  T gap_to_wall(bool left) const {
    const GasWall<T>& wall = *walls[left ? 0 : 1];
    const T at = wall.origin + wall.v * time;
    return left ? T(place(cells.front()) - at) : T(at - place(cells.back()));
  }
  std::size_t pairs() const { return cells.size() < 2 ? 0 : length > 0 ? cells.size() : cells.size() - 1; }

 private:
  std::int64_t last() const { return static_cast<std::int64_t>(cells.size()) - 1; }
  T flown(const Cell& cell) const { return cell.origin + cell.v * time; }

  static std::optional<T> closes(const T& apart, const T& w) {
    return w > 0 ? std::optional(T(apart / w)) : std::nullopt;
  }
  // When the outermost particle meets a wall. Under gravity gap - w t - p t^2/2 = 0, the next time from now; just after
  // their own collision the gap is 0.
  std::optional<T> meets_wall(bool left) const {
    const Cell& cell = left ? cells.front() : cells.back();
    const GasWall<T>& wall = *walls[left ? 0 : 1];
    if (acceleration == 0)
      return left ? closes(cell.origin - wall.origin, wall.v - cell.v)
                  : closes(wall.origin - cell.origin, cell.v - wall.v);
    const T p = left ? T(-acceleration) : acceleration,
            w = left ? T(wall.v - velocity(cell)) : T(velocity(cell) - wall.v);
    if (latest && *latest == (left ? -1 : last()) && *cell.touched == time) {
      const T back = -2 * w / p;
      return back > 0 ? std::optional(T(time + back)) : std::nullopt;
    }
    const T square = w * w + 2 * p * gap_to_wall(left);
    if (!(square > 0)) return {};
    std::optional<T> soonest;
    for (const T& root : {T((-w - sqrt(square)) / p), T((-w + sqrt(square)) / p)})
      if (root > 0 && (!soonest || root < *soonest)) soonest = root;
    if (!soonest) return {};
    return T(time + *soonest);
  }
  std::size_t after(std::size_t k) const { return k + 1 < cells.size() ? k + 1 : 0; }
  T seam(std::size_t k) const { return k + 1 < cells.size() ? T(0) : length; }

  std::pair<std::int64_t, std::int64_t> strike(bool left) {
    Cell& cell = left ? cells.front() : cells.back();
    GasWall<T>& wall = *walls[left ? 0 : 1];
    const T x = flown(cell), before = velocity(cell), relative = before - wall.v, size = left ? T(-relative) : relative;
    const bool below = acceleration != 0 && law != GasLaw::contact_time && size < cutoff,
               soon = acceleration != 0 && law == GasLaw::contact_time && cell.touched &&
                      time - *cell.touched < contact_time;
    const T of_wall = below || soon ? T(1) : wall.restitution;
    T after = wall.v - of_wall * relative;
    if (wall.random_speed) after = wall.v + (left ? 1 : -1) * wall.random_speed(wall.collisions, cell.m);
    cell.v += after - before;
    cell.origin = x - cell.v * time;
    cell.touched = time;
    // The energy of the particle changes by what is given, less what is lost.
    const T gain = cell.m * (after * after - before * before) / 2, inner = cell.m * relative * relative / 2;
    const T lost = wall.random_speed ? T(0) : T(inner * (1 - of_wall * of_wall));
    wall.lost += lost;
    wall.given += gain + lost;
    wall.momentum += cell.m * (after - before);
    below_cutoff += (below || soon) && !wall.random_speed;  // a thermal wall is never elastic
    ++wall.collisions, ++collisions;
    const std::int64_t particle = cell.particles.front();
    return left ? std::pair{std::int64_t{-1}, particle} : std::pair{particle, last() + 1};
  }

  void collide(std::size_t k, bool wrong_side) {
    Cell &l = cells[k], &r = cells[after(k)];
    const T w = l.v - r.v, all = l.m + r.m, reduced = l.m * r.m / all;
    const auto rested = [&](const Cell& cell) { return cell.touched && time - *cell.touched < contact_time; };
    const bool memory = law == GasLaw::contact_time && (rested(l) || rested(r));
    ++collisions;
    l.touched = r.touched = time;
    const T x_l = flown(l), x_r = flown(r);
    if (law == GasLaw::sticky || (law == GasLaw::merging && w < merge_speed) ||
        (law == GasLaw::wet && !(w * w > 2 * loss / reduced)))
      return merge(k, x_l);
    if (law == GasLaw::wet) return pass(k, sqrt(T(w * w - 2 * loss / reduced)), x_l, x_r);
    const bool below = memory || (law != GasLaw::merging && (w < cutoff) != wrong_side);
    below_cutoff += below;
    T kept = below ? T(1) : restitution;
    if (cutoff_exponent > 0) kept = restitution + (1 - restitution) * exp(T(-pow(T(w / cutoff), cutoff_exponent)));
    const T impulse = reduced * w * (1 + kept);
    l.v -= impulse / l.m;
    r.v += impulse / r.m;
    l.origin = x_l - l.v * time;
    r.origin = x_r - r.v * time;
  }
  // The first particle of a cell is the heaviest that merged, the left one of equal ones.
  void merge(std::size_t k, const T& x) {
    Cell &l = cells[k], &r = cells[after(k)];
    ++merges;
    if (l.m < r.m) std::swap(l.particles, r.particles);
    l.v = (l.m * l.v + r.m * r.v) / (l.m + r.m);
    l.m += r.m;
    l.origin = x - l.v * time;
    l.particles.insert(l.particles.end(), r.particles.begin(), r.particles.end());
    cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(after(k)));
  }
  // The closing speed becomes a speed of separation.
  void pass(std::size_t k, const T& parting, const T& x_l, const T& x_r) {
    Cell &l = cells[k], &r = cells[after(k)];
    const T all = l.m + r.m, centre = (l.m * l.v + r.m * r.v) / all;
    l.v = centre + r.m * parting / all;
    r.v = centre - l.m * parting / all;
    std::swap(l.v, r.v), std::swap(l.m, r.m), std::swap(l.particles, r.particles), std::swap(l.touched, r.touched);
    l.origin = x_l - l.v * time;
    r.origin = x_r - r.v * time;
  }
};

}  // namespace cradle::test
