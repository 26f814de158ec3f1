#include "cradle/tools/setup/word_start.hpp"

#include <fmt/format.h>

#include <algorithm>

#ifdef CRADLE_WITH_MPFR
#include "cradle/precision/mpfr.hpp"
#else
#include "cradle/precision/bin_float.hpp"
#endif

namespace cradle::tools {

bool WordParticles::symmetric() const {
  return left_wall == right_wall && std::equal(masses.begin(), masses.end(), masses.rbegin());
}

std::string WordParticles::text() const {
  std::string text = fmt::format("{} particles", particles);
  if (masses.empty()) {
    text += " of equal masses";
  } else {
    text += " of masses ";
    for (std::size_t i = 0; i < masses.size(); ++i) text += (i > 0 ? ", " : "") + masses[i].text;
  }
  if (left_wall && right_wall) return text + " between two walls";
  return text + (left_wall ? " right of a wall" : right_wall ? " left of a wall" : "");
}

std::string cut_off(std::string_view number, unsigned digits) {
  auto [negative, all, power] = literal_of(number);
  // The digits up to the last one that is kept, one before the point at least.
  all.resize(static_cast<std::size_t>(std::max<std::int64_t>(0, std::ssize(all) + power + digits)), '0');
  if (all.size() <= digits) all.insert(0, digits + 1 - all.size(), '0');
  all.insert(all.size() - digits, ".");
  return (negative ? "-" : "") + all;
}

words::Word word_at(const Place& place, const std::string& letters, std::size_t gaps) {
  try {
    return words::read_word(letters, gaps);
  } catch (const words::BadWord& bad) {
    throw Error(place, bad.what(), bad.found, bad.advice);
  }
}

void check_word(const Place& place, const Scene& scene) {
  if (particles_merge(scene) || scene.initial.on_ring())
    throw Error(place, "letters are of particles on a line that bounce",
                scene.initial.on_ring() ? "a ring" : "particles that merge", "remove it, or give output.events");
  const std::size_t gaps = scene.gaps(), most = 26;
  if (gaps < 2 || gaps > most)
    throw Error(place, "not a few particles", fmt::format("{} gaps", gaps), fmt::format("give 2 to {}", most));
  if (*scene.output.word != any_word) word_at(place, *scene.output.word, gaps);
}

namespace {

template <class T> WordStart start_in(const WordParticles& particles, const words::Word& word, const Decimal& r) {
  constexpr long double tolerance = 1e-11L;
  words::System<long double> quick(word, shares_in<long double>(particles));
  quick = words::in_order_of_time(quick, from_text<long double>(r.text), tolerance, words::Begin::first);
  const words::System<T> system(quick.word, shares_in<T>(particles));
  const T restitution = from_text<T>(r.text);
  const auto found = words::find(system, restitution, T(0));
  if (found.verdict != words::Verdict::exists) return {};
  return start_text(particles, system, restitution, words::followed(system, restitution, found.pairs),
                    particles.digits);
}

// In a type with many more digits: eigenvalues are far apart.
WordStart start_with(const WordParticles& particles, const words::Word& word, const Decimal& r) {
#ifdef CRADLE_WITH_MPFR
  const unsigned working = std::min(particles.digits + particles.digits / 4 + 40, 1070U);
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(working));
  if (Mpfr<8>::holds(working)) return start_in<Mpfr<8>>(particles, word, r);
  return start_in<Mpfr<56>>(particles, word, r);
#else
  if (particles.digits > 80)
    throw Error({"", 0, "run.digits"}, "no words of so many digits in this build", fmt::format("{}", particles.digits),
                "install libmpfr-dev (Debian's name) and build again");
  return start_in<bin_float>(particles, word, r);
#endif
}

}  // namespace

void start_from_word(const Place& place, Scene& scene) {
  const std::string text = *scene.initial.file;
  WordParticles particles;
  particles.left_wall = scene.walls.left.position.has_value();
  particles.right_wall = scene.walls.right.position.has_value();
  particles.digits = std::max(scene.run.decimal_digits(), 20U) + 10;
  for (std::size_t i = 0; i < scene.initial.m.size(); ++i) particles.masses.emplace_back(scene.initial.m[i]);
  // Every gap closes in a word, so its last letter says how many there are.
  const char last = text.empty() ? 'a' : *std::max_element(text.begin(), text.end());
  const std::size_t gaps = last >= 'b' && last <= 'f' ? static_cast<std::size_t>(last - 'a') + 1 : 2;
  particles.particles = gaps + 1 - particles.left_wall - particles.right_wall;
  if (!particles.masses.empty() && particles.masses.size() != particles.particles)
    throw Error({place.source, place.line, "initial.m"}, "not one mass per particle of the word",
                fmt::format("{} for {}", particles.masses.size(), particles.particles), "give as many");
  const WordStart start = start_with(particles, word_at(place, text, gaps), scene.law.restitution);
  if (start.x.empty())
    throw Error(place, "a word without a self-similar state at this restitution",
                fmt::format("{} at {}", text, scene.law.restitution.text),
                fmt::format("see `cradle words {} {}`", particles.particles, text));
  scene.initial.x = {}, scene.initial.v = {};
  for (const std::string& x : start.x) scene.initial.x.push_back(x);
  for (const std::string& v : start.v) scene.initial.v.push_back(v);
  scene.initial.file.reset();
}

}  // namespace cradle::tools
