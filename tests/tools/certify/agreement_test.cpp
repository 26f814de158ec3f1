// A proof and its run that do not agree: whatever is planted in what the run says of itself, in every precision, ends
// the program with the quantity by name, and never in a certificate.
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "cradle/tools/certify/certify.hpp"

namespace agreement_test {

using namespace cradle;
using namespace cradle::tools;

using Plant = std::function<void(RunLook&)>;

class Tampered final : public Certifier {
 public:
  Tampered(std::unique_ptr<Certifier> proof, Plant plant) : proof_(std::move(proof)), plant_(std::move(plant)) {}
  void contact(BodyIndex left, BodyIndex right, double time) override { proof_->contact(left, right, time); }
  void look(const RunLook& look) override {
    RunLook changed = look;
    plant_(changed);
    proof_->look(changed);
  }
  Certificate certificate() const override { return proof_->certificate(); }

 private:
  std::unique_ptr<Certifier> proof_;
  Plant plant_;
};

const char* const shock = R"(
law = {type = "inelastic", restitution = 0.9, cutoff = 0.1}
initial = {type = "rows", particles = 20, speed = 0.5, spacing = 1, perturbation = 0.1}
run.until = 12
output.series = {points = 4}
output.snapshots = [5, 10]
)";

Certified certified(const std::string& toml, const Plant& plant) {
  CertifyOptions how;
  how.digits = {31};
  how.progress = Progress::Show::never;
  how.make = [&](const Scene& scene, unsigned digits) {
    return std::make_unique<Tampered>(certifier(scene, digits), plant);
  };
  return certify(parse_scene(toml, "shock", {}), how);
}

std::string moved(const std::string& number, double by) {
  return to_text(from_text<double_double>(number) + double_double(by));
}

TEST(Agreement, OfAProofAndItsRun) {
  const Certified run = certified(shock, [](RunLook&) {});
  EXPECT_TRUE(run.proved());
  EXPECT_EQ(run.attempts.size(), 1U);
  EXPECT_GT(run.certificate.contacts, 50U);
}

TEST(Agreement, WhateverIsPlantedIsFoundAndNamed) {
  const std::pair<const char*, Plant> plants[] = {
      {"front_left",
       [](RunLook& look) {
         if (!look.front_left.empty()) look.front_left = moved(look.front_left, 1e-9);
       }},
      {"front_right",
       [](RunLook& look) {
         if (look.time > 11) look.front_right = moved(look.front_right, -1e-9);
       }},
      {"front_left",
       [](RunLook& look) {
         if (look.time > 11) look.front_left.clear();
       }},
      {"front_right",
       [](RunLook& look) {
         if (look.time == 0) look.front_right = "1";
       }},
      {"energy", [](RunLook& look) { look.energy = moved(look.energy, 1e-10); }},
      {"energy",
       [](RunLook& look) {
         if (look.time > 3) look.energy = "nan";
       }},
      {"contacts", [](RunLook& look) { look.counts.contacts += look.time > 11; }},
      {"contacts_below_cutoff", [](RunLook& look) { look.counts.below_cutoff += look.time > 11; }},
      {"merges", [](RunLook& look) { look.counts.merges += 1; }},
      {"time of the sample",
       [](RunLook& look) {
         if (look.time > 3) look.time_text = moved(look.time_text, 1e-12);
       }},
      {"x of body 7 in the snapshot",
       [](RunLook& look) {
         for (std::size_t j = 0; j < look.bodies.x.size(); ++j)
           if (look.bodies.index[j] == 7) look.bodies.x[j] = moved(look.bodies.x[j], 1e-9);
       }},
      {"v of body 12 in the snapshot",
       [](RunLook& look) {
         for (std::size_t j = 0; j < look.bodies.v.size(); ++j)
           if (look.time > 9 && look.bodies.index[j] == 12) look.bodies.v[j] = moved(look.bodies.v[j], 1e-10);
       }},
      {"m of body 9 in the snapshot",
       [](RunLook& look) {
         for (std::size_t j = 0; j < look.bodies.m.size(); ++j)
           if (look.bodies.index[j] == 9) look.bodies.m[j] = "1.0000000001";
       }},
      {"of body 8 in the snapshot",
       [](RunLook& look) {
         for (BodyIndex& body : look.bodies.index) body = body == 8 ? -1 : body;
       }},
      {"in one cluster", [](RunLook& look) {
         for (BodyIndex& body : look.bodies.index) body = body == 8 ? 7 : body;
       }}};
  for (const auto& [quantity, plant] : plants) {
    try {
      certified(shock, plant);
      ADD_FAILURE() << quantity << " is off, and proved";
    } catch (const Error& error) {
      EXPECT_EQ(error.status, Exit::lost) << error.what();
      const std::string message = error.what();
      EXPECT_NE(message.find("do not agree"), message.npos) << message;
      EXPECT_NE(message.find(quantity), message.npos) << quantity << ": " << message;
    }
  }
}

TEST(Agreement, AnErrorOfARunInDoubleAsksForAWiderOne) {
  const Certified run = certified(shock, [](RunLook& look) {
    if (look.epsilon > 1e-20L) look.energy = moved(look.energy, 1e-9);
  });
  EXPECT_TRUE(run.proved());
  ASSERT_EQ(run.attempts.size(), 2U);
  EXPECT_NE(run.attempts.front().doubt.find("the run's energy is not what is proved of it"), std::string::npos)
      << run.attempts.front().doubt;
}

TEST(Agreement, ARunThatEndsBeforeItsTimeIsProvedUpToThere) {
  Certified run;
  run.scene = parse_scene(shock, "shock", {});
  run.certificate.contacts = 7;
  run.certificate.samples.push_back({});
  run.certificate.samples.back().time_text = "3.25";
  run.outcome.end = RunEnd::exhausted;
  EXPECT_FALSE(run.proved());
  EXPECT_NE(
      certificate_text(run).find("undecided from t = 3.25 on, after 7 contacts: the run ended there, before t = 12"),
      std::string::npos)
      << certificate_text(run);
  run.outcome.end = RunEnd::collapsed;
  EXPECT_TRUE(run.proved());
  EXPECT_NE(certificate_text(run).find("not proved: that this is an inelastic collapse"), std::string::npos);
}

}  // namespace agreement_test
