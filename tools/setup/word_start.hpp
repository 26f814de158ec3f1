// Words of scenes, and the self-similar state of a word as decimals: gaps and closing speeds, positions and velocities.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/core/words/ranges.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// The particles of a word.
struct WordParticles {
  std::size_t particles = 3;
  std::vector<Decimal> masses;  // empty: all 1
  bool left_wall = false, right_wall = false;
  unsigned digits = 30;

  std::size_t gaps() const { return particles - 1 + left_wall + right_wall; }
  /// Whether a word and its mirror image are the same motion.
  bool symmetric() const;
  std::string text() const;  // "4 particles of equal masses"
};

/// Half-way from the last collision of a period to the first one, in units in which the gaps together and the largest
/// closing speed are 1. A wall is at rest, at 0 on the left or 1 on the right; without one the first particle is at 0
/// and the momentum is 0.
struct WordStart {
  std::vector<std::string> gaps, speeds, x, v;
  std::string collapse;  // the time from then on until the collapse is complete
};

/// A decimal number with so many digits after the point; what follows is cut off.
std::string cut_off(std::string_view number, unsigned digits);

template <class N> words::Shares<N> shares_in(const WordParticles& particles) {
  std::vector<N> masses(particles.particles, N(1));
  for (std::size_t i = 0; i < particles.masses.size(); ++i) masses[i] = Text<N>::from(particles.masses[i].text);
  return words::shares(masses, {particles.left_wall, particles.right_wall});
}

template <class T>
WordStart start_text(const WordParticles& particles, const words::System<T>& system, const T& r,
                     const words::Pairs<T>& pairs, unsigned digits) {
  words::Start<T> start = words::start_of(system, r, pairs);
  T extent(0), fastest(0);
  for (const T& gap : start.gaps) extent += gap;
  for (const T& speed : start.speeds)
    if (fastest < magnitude(speed)) fastest = magnitude(speed);
  for (T& gap : start.gaps) gap /= extent;
  for (T& speed : start.speeds) speed /= fastest;
  const auto shown = [&](const T& number) { return cut_off(to_text(number), digits); };
  WordStart text;
  for (const T& gap : start.gaps) text.gaps.push_back(shown(gap));
  for (const T& speed : start.speeds) text.speeds.push_back(shown(speed));
  text.collapse = shown(T(start.collapse * fastest / extent));

  std::vector<T> x, v;
  if (!particles.left_wall) x.push_back(T(0)), v.push_back(T(0));
  for (std::size_t i = 0; i < particles.gaps() - particles.right_wall; ++i) {
    x.push_back((x.empty() ? T(0) : x.back()) + start.gaps[i]);
    v.push_back((v.empty() ? T(0) : v.back()) - start.speeds[i]);
  }
  T drift(0), mass(0);
  if (particles.right_wall) {
    drift = v.back() - start.speeds.back();
  } else if (!particles.left_wall) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      const T m = particles.masses.empty() ? T(1) : from_text<T>(particles.masses[i].text);
      drift += m * v[i], mass += m;
    }
    drift /= mass;
  }
  for (const T& place : x) text.x.push_back(shown(place));
  for (const T& speed : v) text.v.push_back(shown(T(speed - drift)));
  return text;
}

/// The word of these letters, which stand at this place. Throws Error.
words::Word word_at(const Place& place, const std::string& letters, std::size_t gaps);

/// Checks output.word, which is at this place, once the particles of a list are read.
void check_word(const Place& place, const Scene& scene);

/// Gives the scene the particles of a word, which is in place of the name of a list, at the scene's restitution, with
/// more digits than its precision has. Throws Error if the word has no self-similar state there.
void start_from_word(const Place& place, Scene& scene);

}  // namespace cradle::tools
