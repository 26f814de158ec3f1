#include "cradle/tools/proof/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/precision/scalars.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

// Compiled once per type of midpoints, in a source of its own.
template <class M> std::unique_ptr<Certifier> certifier_in(const Scene& scene, unsigned digits);

std::unique_ptr<Certifier> certifier(const Scene& scene, unsigned digits) {
  if (digits == 31) return certifier_in<double_double>(scene, digits);
#ifdef CRADLE_WITH_MPFR
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(digits));
  if (Mpfr<4>::holds(digits)) return certifier_in<Mpfr<4>>(scene, digits);
  if (Mpfr<16>::holds(digits)) return certifier_in<Mpfr<16>>(scene, digits);
  if (Mpfr<56>::holds(digits)) return certifier_in<Mpfr<56>>(scene, digits);
#endif
  throw Error({}, "no balls of so many digits in this build", fmt::format("{}", digits),
              "install libmpfr-dev (Debian's name) and build again, or give at most 1000 digits");
}

std::vector<unsigned> rising_digits() {
#ifdef CRADLE_WITH_MPFR
  return {31, 50, 100, 200, 400, 800};
#else
  return {31};
#endif
}

std::optional<Error> not_provable(const Scene& scene) {
  const auto because = [](const char* key, const char* what, const std::string& found,
                          const char* instead = "compare precisions with `cradle trust` instead") {
    return Error({"", 0, key}, what, found, instead);
  };
  if (scene.initial.type == InitialType::clusters)
    return because("initial.type", "no collisions to prove", "clusters, a model", "give a scene of particles");
  if (!law_row(scene).provable)
    return because("law.type", "no proof of this law", value_text(*find_field("law.type", scene), scene).value());
  if (scene.walls.shaken())
    return because(scene.walls.left.shaken() ? "walls.left.motion" : "walls.right.motion",
                   "shaken walls are not provable", "a shaken wall");
  if (const auto& left = scene.walls.left.rest_speed; left || scene.walls.right.rest_speed)
    return because(left ? "walls.left.rest_speed" : "walls.right.rest_speed", "rest on a wall is not provable",
                   (left ? left : scene.walls.right.rest_speed)->text);
  return {};
}

void check_certifiable(const Scene& scene) {
  check_built(scene);
  if (const auto reason = not_provable(scene)) throw *reason;
}

namespace {

// Raises the precision of the run that proposes collisions, after it has proposed wrong ones.
bool raise(Scene& scene, unsigned digits) {
  switch (scene.run.precision) {
  case Precision::double_:
  case Precision::long_double:
    scene.run.precision = Precision::double_double;
    return true;
  case Precision::mpfr:
    return false;
  default:
#ifdef CRADLE_WITH_MPFR
    scene.run.precision = Precision::mpfr;
    scene.run.digits = std::max(digits, 50U);
    return true;
#else
    return digits > 1000;
#endif
  }
}

// Whether the proof ends at a collision that the run has made.
bool ends(Certifier& proof) {
  try {
    proof.check_all();
    return false;
  } catch (const ProofEnds&) {
    return true;
  }
}

}  // namespace

Certified certify(const Scene& requested, const CertifyOptions& options) {
  check_certifiable(requested);
  Scene scene = requested;
  std::vector<Attempt> attempts;
  // One of them checks what the others propose.
  const unsigned threads = thread_count(options.threads);
  const Threads of_run(std::max(threads, 2U) - 1);
  auto digits = options.digits.begin();
  // One number of digits per process: a run in MPFR and its balls have the same.
  const auto in_step = [&] {
    if (scene.run.precision != Precision::mpfr) return *digits;
    while (digits + 1 != options.digits.end() && *digits < scene.run.digits) ++digits;
    scene.run.digits = std::max<std::uint64_t>(scene.run.digits, *digits);
    return static_cast<unsigned>(scene.run.digits);
  };
  for (;;) {
    const auto started = std::chrono::steady_clock::now();
    const unsigned of_balls = in_step();
    const auto observer = options.make(scene, of_balls);
    if (threads > 1) observer->check_beside();
    RunOutcome outcome;
    try {
      outcome = run_scene(scene, {options.progress, observer.get(), options.interrupt, workers(of_run)});
    } catch (const ProofEnds&) {
    } catch (const Error& error) {  // a guard of the run: it was wrong, as if a collision of it had been
      const bool ended = ends(*observer);
      if (!ended && (error.status != Exit::lost || !raise(scene, of_balls))) throw;
      if (!ended) continue;
    }
    if (outcome.end == RunEnd::interrupted)
      throw Error({}, "interrupted", "", "run it again; nothing is kept of a proof that did not finish",
                  status_of_signal(options.interrupt->signal()));
    Certificate certificate = observer->certificate();
    if (!certificate.doubt) certificate.doubt = observer->disagreement(outcome.result);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    const auto& doubt = certificate.doubt;
    attempts.push_back({precision_name(scene.run), certificate.digits_text, seconds, doubt ? doubt_text(*doubt) : ""});
    const bool last = digits + 1 == options.digits.end();
    // Collisions that are wrong require more digits of the run, those that are open more digits of the balls.
    const bool raised = doubt && doubt->refuted && raise(scene, of_balls);
    if (doubt && doubt->check == Check::agreement && last && !raised)
      throw Error(
          {}, "the proof and its run do not agree in any precision, so one of them is wrong", doubt_text(*doubt),
          "nothing of this can be called proved; report it as an error of the program, with the scene", Exit::lost);
    if (!doubt || (last && !raised))
      return {std::move(scene), std::move(outcome), std::move(certificate), std::move(attempts)};
    if (!raised) ++digits;
  }
}

}  // namespace cradle::tools
