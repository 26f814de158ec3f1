// A gas that shares no code with the engine or the checker of proofs, on a line, a ring or between walls: it searches
// all pairs of neighbours for the next collision. A particle's stored position is extrapolated back to time 0, which
// keeps rationals short. In rationals it is exact; scenes with roots use 100 digits. Under gravity this is so in a
// frame that falls; of both times at which a parabola meets a wall, each by the textbook's formula, it takes the first
// that is to come. The gap to a shaken wall is followed in small steps. Particles that a wall holds are held one on the
// other, until it falls faster than what is free.
#pragma once

#include <functional>

#include "cradle/core/initial/particles.hpp"
#include "cradle/precision/bin_float.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/precision/shaking.hpp"

namespace cradle::test {

enum class GasLaw { inelastic, contact_time, merging, sticky, wet };

// A wall on either side of particles that bounce, with its account; its place is at time 0.
template <class T> struct GasWall {
  T origin, v, restitution;
  std::function<T(std::uint64_t collision, const T& mass)> random_speed{};  // of a thermal wall
  std::optional<Shaking<T>> shaking{};
  T rest_speed{0};  // slower particles stay on it while it presses them
  std::uint64_t collisions = 0;
  T given{0}, momentum{0}, lost{0};
};

// Merged particles are one cell; cells are ordered from left to right, on a ring up to the seam.
template <class T> struct Gas {
  struct Cell {
    T origin, v, m;
    std::vector<std::int64_t> particles;
    std::optional<T> touched{}, met_next{};        // the time of its last collision, and with the one on its right
    std::array<std::optional<T>, 2> at_wall = {};  // when it was last in touch with a wall, or with what rests on it
    bool rests = false;
  };
  std::vector<Cell> cells;
  GasLaw law = GasLaw::inelastic;
  T restitution{1}, cutoff{0}, contact_time{0}, merge_speed{0}, loss{0}, length{0};
  T acceleration{0};                                 // of all particles, between walls; then roots are needed
  T cutoff_exponent{0};                              // above 0: the restitution depends on the speed
  std::array<std::optional<GasWall<T>>, 2> walls{};  // left, right

  T time{0};
  std::uint64_t collisions = 0, below_cutoff = 0, merges = 0, rested = 0, let_go = 0;
  std::optional<std::int64_t> latest{};  // the gap that closed last
  bool tied = false;                     // three particles met at one time: the motion after that is undefined,
  bool ties_from_left = false;           // unless such collisions are made from the left

  // Makes all collisions up to a time, or the first `most`.
  void advance(const T& until, std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
    while (collisions < most && next(until)) continue;
    if (collisions < most) wait_until(until);
  }
  // Makes the next collision not after `until`; `wrong_side`: as if it were on the other side of the cut-off.
  std::optional<std::pair<std::int64_t, std::int64_t>> next(const T& until, bool wrong_side = false) {
    if (tied) return std::nullopt;
    std::optional<T> first;
    std::vector<std::int64_t> together;  // gaps, by the cell on their left; -1: the left wall
    const auto may_close = [&](std::int64_t gap, std::optional<T> due) {
      // Rounding parts what is at one time where particles touch; rationals do not.
      if (!std::numeric_limits<T>::is_exact && due && *due - time < T(1e-60)) due = time;
      if (due && (!first || *due < *first)) first = due, together.clear();
      if (due && *due == *first) together.push_back(gap);
    };
    for (std::size_t k = 0; k < pairs(); ++k) {
      const Cell &l = cells[k], &r = cells[after(k)];
      if (l.rests || r.rests) continue;
      const auto due = closes(r.origin + seam(k) - l.origin, l.v - r.v);
      may_close(static_cast<std::int64_t>(k), due && l.met_next == time ? time : due);
    }
    if (walls[0]) may_close(gap_beside(true), meets_wall(true, until));
    if (walls[1]) may_close(gap_beside(false), meets_wall(false, until));
    if (const auto free = end_of_rest(); free && *free <= until && !(first && *first < *free)) {
      wait_until(*free, *phase_of_release());
      for (Cell& cell : cells) set_free(cell, *phase_of_release());
      ++let_go;
      return next(until, wrong_side);
    }
    if (!first || *first > until) return std::nullopt;
    const bool in_turn = ties_from_left || (holds() && *first == time);  // what touches in a pile is hit from the left
    wait_until(*first);
    for (const std::int64_t a : together)
      for (const std::int64_t b : together)
        tied =
            tied || (!in_turn && (a - b == 1 || (length > 0 && a != b &&
                                                 after(static_cast<std::size_t>(b)) == static_cast<std::size_t>(a))));
    if (tied) return std::nullopt;
    const std::int64_t gap = *std::ranges::min_element(together);
    latest = gap;
    for (const bool left : {true, false})
      if (walls[left ? 0 : 1] && gap == gap_beside(left)) return strike(left);
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
  T place(const Cell& cell) const {
    return cell.rests ? wall_place(on_left()) : T(flown(cell) + acceleration * time * time / 2);
  }
  T velocity(const Cell& cell) const { return cell.rests ? wall_speed(on_left()) : T(cell.v + acceleration * time); }
  T gap_after(std::size_t k) const { return place(cells[after(k)]) - place(cells[k]) + seam(k); }
  T gap_to_wall(bool left) const {
    return left ? T(place(cells.front()) - wall_place(true)) : T(wall_place(false) - place(cells.back()));
  }
  std::size_t pairs() const { return cells.size() < 2 ? 0 : length > 0 ? cells.size() : cells.size() - 1; }

 private:
  std::int64_t last() const { return static_cast<std::int64_t>(cells.size()) - 1; }
  T flown(const Cell& cell) const { return cell.origin + cell.v * time; }

  static std::optional<T> closes(const T& apart, const T& w) {
    return w > 0 ? std::optional(T(apart / w)) : std::nullopt;
  }
  // ---- walls; the phase of one that is shaken is in turns
  T turns(bool left, const T& at) const {
    const GasWall<T>& wall = *walls[left ? 0 : 1];
    return wall.shaking ? wall.shaking->turns(at) : T(0);
  }
  T wall_place(bool left) const { return wall_place(left, turns(left, time)); }
  T wall_speed(bool left) const { return wall_speed(left, turns(left, time)); }
  T wall_place(bool left, const T& phase) const {
    const GasWall<T>& wall = *walls[left ? 0 : 1];
    return wall.origin + wall.v * time + (wall.shaking ? T((left ? 1 : -1) * wall.shaking->place(phase)) : T(0));
  }
  T wall_speed(bool left, const T& phase) const {
    const GasWall<T>& wall = *walls[left ? 0 : 1];
    return wall.v + (wall.shaking ? T((left ? 1 : -1) * wall.shaking->speed(phase)) : T(0));
  }
  bool shaken() const {
    return std::ranges::any_of(walls, [](const auto& wall) { return wall && wall->shaking; });
  }
  bool holds() const {
    return std::ranges::any_of(walls, [](const auto& wall) { return wall && wall->rest_speed > 0; });
  }
  T pull(bool left) const { return left ? T(-acceleration) : acceleration; }

  // The outermost particle that does not rest meets a wall, or those that rest there, next. One that is in touch with
  // it has no gap to it; under gravity gap - w t - p t^2/2 = 0.
  std::optional<T> meets_wall(bool left, const T& until) const {
    if (resting() == last() + 1) return {};
    const Cell& cell = outermost_free(left);
    const GasWall<T>& wall = *walls[left ? 0 : 1];
    const T w = left ? T(wall_speed(true) - velocity(cell)) : T(velocity(cell) - wall_speed(false));
    const bool in_touch = cell.at_wall[left ? 0 : 1] == time;
    if (in_touch && w > 0) return time;
    if (wall.shaking) return meets_shaken_wall(cell, left, until);
    const T p = pull(left), gap = left ? T(place(cell) - wall_place(true)) : T(wall_place(false) - place(cell));
    if (p == 0) {
      const T at_start = left ? T(cell.origin - wall.origin) : T(wall.origin - cell.origin);
      return closes(at_start, w);
    }
    if (in_touch) {
      const T back = -2 * w / p;
      return back > 0 || (w == 0 && wall.rest_speed > 0) ? std::optional(T(time + back)) : std::nullopt;
    }
    const T square = w * w + 2 * p * gap;
    if (!(square > 0)) return {};
    std::optional<T> soonest;
    for (const T& root : {T((-w - sqrt(square)) / p), T((-w + sqrt(square)) / p)})
      if (root > 0 && (!soonest || root < *soonest)) soonest = root;
    if (!soonest) return {};
    return T(time + *soonest);
  }

  // The gap to a shaken wall as a curve.
  template <class N> struct Curve {
    Shaking<N> wall;
    N since, gap, opening, bend;
    N at(const N& t) const { return gap + opening * t + bend * t * t / 2 - wall.place(wall.turns(since + t)); }
    N rate(const N& t) const { return opening + bend * t - wall.speed(wall.turns(since + t)); }
  };
  template <class N> Curve<N> curve(const Cell& cell, bool left) const {
    const GasWall<T>& wall = *walls[left ? 0 : 1];
    const auto in = [&](const T& x) { return static_cast<N>(left ? x : T(-x)); };
    const Shaking<T>& by = *wall.shaking;
    return {{by.shape, static_cast<N>(by.amplitude), static_cast<N>(by.frequency), static_cast<N>(by.phase)},
            static_cast<N>(time),
            in(place(cell) - wall.origin - wall.v * time),
            in(velocity(cell) - wall.v),
            in(acceleration)};
  }
  // The first crossing, in doubles, between samples or before a minimum or the tip of a tooth; then Newton's steps.
  // Gaps of 1e-13 count as 0.
  std::optional<T> meets_shaken_wall(const Cell& cell, bool left, const T& until) const {
    const Curve<double> rough = curve<double>(cell, left);
    const double period = rough.wall.period(), end = static_cast<double>(T(until - time)) + period;
    double before = 0, after = 0;
    for (double step = 1e-9; before < end; step = std::min(1.25 * step, period / 48), before = after) {
      after = before + step;
      const double tip = before + (0.5 - rough.wall.turns(rough.since + before)) * period;
      if (rough.wall.shape == Shape::sawtooth && before + 1e-10 < tip && tip < after) after = tip - 1e-11;
      if (rough.rate(before) < 0 && rough.rate(after) > 0)
        if (const double least = bisected(before, after, [&](double t) { return rough.rate(t) < 0; });
            rough.at(least) < 0)
          after = least;
      if (!(rough.at(after) < -1e-13)) continue;
      T wait(bisected(before, after, [&](double t) { return rough.at(t) > 0; }));
      const Curve<T> exact = curve<T>(cell, left);
      for (int k = 0; k < 10; ++k) wait -= exact.at(wait) / exact.rate(wait);
      return T(time + wait);
    }
    return {};
  }
  // Where it is no longer true.
  template <class True> static double bisected(double low, double high, const True& is_true) {
    for (int k = 0; k < 60; ++k) (is_true((low + high) / 2) ? low : high) = (low + high) / 2;
    return high;
  }

  // ---- particles that rest on a wall, of which there is one that holds any
  bool on_left() const { return walls[0] && walls[0]->rest_speed > 0; }
  std::int64_t resting() const { return std::ranges::count_if(cells, &Cell::rests); }
  Cell& outermost_free(bool left) {
    const auto below = static_cast<std::size_t>(left == on_left() ? resting() : 0);
    return left ? cells[below] : cells[cells.size() - 1 - below];
  }
  const Cell& outermost_free(bool left) const { return const_cast<Gas&>(*this).outermost_free(left); }
  // The gap to the wall or to what rests on it.
  std::int64_t gap_beside(bool left) const {
    const std::int64_t below = left == on_left() ? resting() : 0;
    return left ? below - 1 : last() - below;
  }
  bool presses(bool left) const {
    const auto& shaking = walls[left ? 0 : 1]->shaking;
    return pull(left) + (shaking ? shaking->acceleration(turns(left, time)) : T(0)) > 0;
  }
  // When the wall lets go of what rests on it.
  std::optional<T> end_of_rest() const {
    const auto* wall = resting() > 0 ? &*walls[on_left() ? 0 : 1] : nullptr;
    if (wall == nullptr || !wall->shaking || !phase_of_release()) return {};
    const T turns = *phase_of_release() - wall->shaking->turns(time);
    return T(time + (turns < 0 ? T(turns + 1) : turns) * wall->shaking->period());
  }
  std::optional<T> phase_of_release() const { return walls[on_left() ? 0 : 1]->shaking->release(pull(on_left())); }
  // From here on it flies, at the speed that the wall has.
  void set_free(Cell& cell, const T& phase) {
    if (!cell.rests) return;
    cell.rests = false;
    cell.v = wall_speed(on_left(), phase) - acceleration * time;
    cell.origin = wall_place(on_left(), phase) - acceleration * time * time / 2 - cell.v * time;
  }
  // Until a time before the next collision the wall carries what rests on it; it has this phase then.
  void wait_until(const T& later) { wait_until(later, resting() > 0 ? turns(on_left(), later) : T(0)); }
  void wait_until(const T& later, const T& phase) {
    const auto enter = [&](int sign, const T& at) {
      for (const Cell& cell : cells) {
        if (!cell.rests) continue;
        GasWall<T>& wall = *walls[on_left() ? 0 : 1];
        const T v = wall_speed(on_left(), at);
        wall.given += sign * cell.m * (v * v / 2 - acceleration * wall_place(on_left(), at));
        wall.momentum += sign * cell.m * (v - acceleration * time);
      }
    };
    enter(-1, resting() > 0 ? turns(on_left(), time) : T(0));
    time = later;
    enter(1, phase);
  }

  std::size_t after(std::size_t k) const { return k + 1 < cells.size() ? k + 1 : 0; }
  T seam(std::size_t k) const { return k + 1 < cells.size() ? T(0) : length; }

  // A collision with a wall, or with what rests there: that stays at rest if the particle does.
  std::pair<std::int64_t, std::int64_t> strike(bool left) {
    Cell& cell = outermost_free(left);
    GasWall<T>& wall = *walls[left ? 0 : 1];
    const std::pair pair{gap_beside(left), gap_beside(left) + 1};
    const T x = flown(cell), before = velocity(cell), of_wall = wall_speed(left), relative = before - of_wall,
            size = left ? T(-relative) : relative;
    const bool stays = size < wall.rest_speed && presses(left), curved = acceleration != 0 || shaken();
    cell.at_wall[left ? 0 : 1] = time;
    if (!stays && left == on_left() && resting() > 0) {
      Cell& top = cells[static_cast<std::size_t>(left ? pair.first : pair.second)];
      set_free(top, turns(left, time));
      top.at_wall[left ? 0 : 1] = time;
      collide(static_cast<std::size_t>(pair.first), false);
      return pair;
    }
    const bool below = curved && law != GasLaw::contact_time && size < cutoff,
               soon = curved && law == GasLaw::contact_time && cell.touched && time - *cell.touched < contact_time,
               elastic = !stays && (below || soon);
    const T kept = stays ? T(0) : elastic ? T(1) : wall.restitution;
    T after = of_wall - kept * relative;
    if (wall.random_speed) after = of_wall + (left ? 1 : -1) * wall.random_speed(wall.collisions, cell.m);
    cell.v += after - before;
    cell.origin = x - cell.v * time;
    cell.touched = time;
    cell.rests = stays;
    rested += stays;
    // The energy of the particle changes by what is given, less what is lost.
    const T gain = cell.m * (after * after - before * before) / 2, inner = cell.m * relative * relative / 2;
    const T lost = wall.random_speed ? T(0) : T(inner * (1 - kept * kept));
    wall.lost += lost;
    wall.given += gain + lost;
    wall.momentum += cell.m * (after - before);
    below_cutoff += elastic && !wall.random_speed;  // a thermal wall is never elastic
    ++wall.collisions, ++collisions;
    return pair;
  }

  void collide(std::size_t k, bool wrong_side) {
    Cell &l = cells[k], &r = cells[after(k)];
    const T w = l.v - r.v, all = l.m + r.m, reduced = l.m * r.m / all;
    const auto just_met = [&](const Cell& cell) { return cell.touched && time - *cell.touched < contact_time; };
    const bool memory = law == GasLaw::contact_time && (just_met(l) || just_met(r));
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
    l.met_next = time;
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
