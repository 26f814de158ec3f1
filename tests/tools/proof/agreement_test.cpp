// A proof and its run that do not agree: an error planted in any quantity that the run reports, in every precision,
// ends the program with the name of the quantity, and never gives a certificate.
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/proof/certify.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace agreement_test {

using namespace cradle;
using namespace cradle::tools;
using cradle::test::has;

using Plant = std::function<void(RunSample&)>;
using PlantInFile = std::function<void(Result&)>;

class Tampered final : public Certifier {
 public:
  Tampered(std::unique_ptr<Certifier> proof, Plant plant, PlantInFile in_file)
      : proof_(std::move(proof)), plant_(std::move(plant)), in_file_(std::move(in_file)) {}
  void collision(ParticleIndex left, ParticleIndex right, double time) override {
    proof_->collision(left, right, time);
  }
  void sample(const RunSample& given) override {
    RunSample changed = given;
    plant_(changed);
    proof_->sample(changed);
  }
  Certificate certificate() const override { return proof_->certificate(); }
  std::optional<ReportedDoubt> disagreement(Result& of_run) const override {
    in_file_(of_run);
    return proof_->disagreement(of_run);
  }

 private:
  std::unique_ptr<Certifier> proof_;
  Plant plant_;
  PlantInFile in_file_;
};

const char* const shock = R"(
law = {type = "inelastic", restitution = 0.9, cutoff = 0.1}
initial = {type = "rows", particles = 20, speed = 0.5, spacing = 1, perturbation = 0.1}
run.until = 12
output.series = {points = 4}
output.snapshots = [5, 10]
)";

Certified certified(
    const std::string& toml, const Plant& plant, const PlantInFile& in_file = [](Result&) {},
    const std::vector<unsigned>& tried = {31}) {
  CertifyOptions how;
  how.digits = tried;
  how.progress = Progress::Show::never;
  how.make = [&](const Scene& scene, unsigned digits) {
    return std::make_unique<Tampered>(certifier(scene, digits), plant, in_file);
  };
  return certify(parse_scene(toml, "shock", {}), how);
}

const char* const between_walls = R"(
law = {type = "inelastic", restitution = 0.9, cutoff = 0.1}
initial = {type = "list", x = [1, 2, 3, 4], v = [1, -1, 0.5, 0], m = [1, 2, 1, 1]}
walls.left = {position = 0, temperature = 1}
walls.right = {position = 5, speed = 0.01, restitution = 0.8}
run.until = 20
output.series = {points = 4}
)";

std::string moved(const std::string& number, double by) {
  return to_text(from_text<double_double>(number) + double_double(by));
}

TEST(Agreement, OfAProofAndItsRun) {
  const Certified run = certified(shock, [](RunSample&) {});
  EXPECT_TRUE(run.proved());
  EXPECT_EQ(run.attempts.size(), 1U);
  EXPECT_GT(run.certificate.collisions, 50U);
}

TEST(Agreement, WhateverIsPlantedIsFoundAndNamed) {
  const std::pair<const char*, Plant> plants[] = {
      {"front_left",
       [](RunSample& at) {
         if (!at.front_left.empty()) at.front_left = moved(at.front_left, 1e-9);
       }},
      {"front_right",
       [](RunSample& at) {
         if (at.time.value > 11) at.front_right = moved(at.front_right, -1e-9);
       }},
      {"front_left",
       [](RunSample& at) {
         if (at.time.value > 11) at.front_left.clear();
       }},
      {"front_right",
       [](RunSample& at) {
         if (at.time.value == 0) at.front_right = "1";
       }},
      {"energy", [](RunSample& at) { at.energy = moved(at.energy, 1e-10); }},
      {"energy",
       [](RunSample& at) {
         if (at.time.value > 3) at.energy = "nan";
       }},
      {"collisions", [](RunSample& at) { at.counts.collisions += at.time.value > 11; }},
      {"collisions_below_cutoff", [](RunSample& at) { at.counts.below_cutoff += at.time.value > 11; }},
      {"merges", [](RunSample& at) { at.counts.merges += 1; }},
      {"time of the sample",
       [](RunSample& at) {
         if (at.time.value > 3) at.time.text = moved(at.time.text, 1e-12);
       }},
      {"x of particle 7 in the snapshot",
       [](RunSample& at) {
         for (std::size_t j = 0; j < at.particles.x.size(); ++j)
           if (at.particles.index[j] == 7) at.particles.x[j] = moved(at.particles.x[j], 1e-9);
       }},
      {"v of particle 12 in the snapshot",
       [](RunSample& at) {
         for (std::size_t j = 0; j < at.particles.v.size(); ++j)
           if (at.time.value > 9 && at.particles.index[j] == 12) at.particles.v[j] = moved(at.particles.v[j], 1e-10);
       }},
      {"m of particle 9 in the snapshot",
       [](RunSample& at) {
         for (std::size_t j = 0; j < at.particles.m.size(); ++j)
           if (at.particles.index[j] == 9) at.particles.m[j] = "1.0000000001";
       }},
      {"of particle 8 in the snapshot",
       [](RunSample& at) {
         for (ParticleIndex& particle : at.particles.index) particle = particle == 8 ? -1 : particle;
       }},
      {"in one cluster", [](RunSample& at) {
         for (ParticleIndex& particle : at.particles.index) particle = particle == 8 ? 7 : particle;
       }}};
  for (const auto& [quantity, plant] : plants) {
    const std::string message = cradle::tests::refusal(Exit::lost, [&plant = plant] { certified(shock, plant); });
    EXPECT_TRUE(has(message, "do not agree")) << quantity;
    EXPECT_TRUE(has(message, quantity));
  }
}

TEST(Agreement, WhateverIsPlantedInTheAccountsOfWallsIsFoundAndNamed) {
  EXPECT_TRUE(certified(between_walls, [](RunSample&) {}).proved());
  const auto of_wall = [](std::size_t side, std::string SampledWall::*which, double by) {
    return [=](RunSample& at) {
      if (at.time.value > 19) at.walls[side].*which = moved(at.walls[side].*which, by);
    };
  };
  const std::pair<const char*, Plant> plants[] = {
      {"energy given by the left wall", of_wall(0, &SampledWall::given, 1e-9)},
      {"momentum given by the left wall", of_wall(0, &SampledWall::momentum, 1e-9)},
      {"energy given by the right wall", of_wall(1, &SampledWall::given, -1e-9)},
      {"momentum given by the right wall", of_wall(1, &SampledWall::momentum, 1e-9)},
      {"energy lost in the right wall", of_wall(1, &SampledWall::dissipated, 1e-9)},
      {"energy lost in the left wall", of_wall(0, &SampledWall::dissipated, 1e-9)},
      {"collisions with the right wall", [](RunSample& at) { at.walls[1].collisions += at.time.value > 19; }}};
  for (const auto& [quantity, plant] : plants) {
    const std::string message =
        cradle::tests::refusal(Exit::lost, [&plant = plant] { certified(between_walls, plant); });
    EXPECT_TRUE(has(message, "do not agree")) << quantity;
    EXPECT_TRUE(has(message, quantity)) << message;
  }
}

// Every dataset of doubles that a proof encloses: an error of 1e-10 in its last number.
TEST(Agreement, WhateverIsPlantedInTheFileIsFoundAndNamed) {
  const std::string scenes[] = {shock + std::string("output.events = true\n"),
                                between_walls + std::string("output.events = true\noutput.snapshots = [4, 20]\n"),
                                "law = {type = 'inelastic', restitution = 0.8}\ninitial = {type = 'ring', particles = "
                                "8}\nrun.until = 3\noutput = {events = true, snapshots = [1.5], series.points = 3}\n"};
  std::set<std::string> found;
  for (const std::string& scene : scenes) {
    std::vector<std::string> columns;
    const Certified run = certified(scene, [](RunSample&) {});
    ASSERT_TRUE(run.proved()) << scene;
    for (const Group& group : run.outcome.result.groups)
      for (const Column& column : group.columns)
        if (std::holds_alternative<std::vector<double>>(column.values))
          columns.push_back(group.name + '/' + column.name);
    for (const std::string& path : columns) {
      const auto plant = [&](Result& result) {
        for (Group& group : result.groups)
          for (Column& column : group.columns)
            if (group.name + '/' + column.name == path)
              if (auto& numbers = std::get<std::vector<double>>(column.values); !numbers.empty())
                for (double& number : numbers) number += 1e-10;
      };
      const std::string message = cradle::tests::refusal(Exit::lost, [&] {
        certified(
            scene, [](RunSample&) {}, plant);
      });
      if (has(message, " of /" + path)) found.insert(path);
    }
  }
  std::set<std::string> all = {"events/closing_speed",
                               "events/interval",
                               "events/time",
                               "series/energy",
                               "series/energy_lost",
                               "series/front_left",
                               "series/front_right",
                               "series/time",
                               "series/wall_left_energy",
                               "series/wall_left_momentum",
                               "series/wall_right_energy",
                               "series/wall_right_momentum"};
  for (const char* column : {"x", "v", "m", "gap", "closing_speed"})
    for (const char* snapshot : {"snapshots/0000/", "snapshots/0001/"}) all.insert(snapshot + std::string(column));
  EXPECT_EQ(found, all);
}

// A gap of 1e-13 at x = 1000 is not the difference of its positions as doubles, 1.137e-13.
TEST(Agreement, SmallGapsFarFromTheOriginAreWhatIsProved) {
  const Certified run = certified("law = {type = 'inelastic', restitution = 0.5}\ninitial = {type = 'list', x = [999, "
                                  "1000, 1000.0000000000001], v = [1, 0, 0]}\nrun.until = 3\noutput = {events = true, "
                                  "snapshots = [0]}\n",
                                  [](RunSample&) {});
  ASSERT_TRUE(run.proved());
  const Group& snapshot = *run.outcome.result.find("snapshots/0000");
  for (const Column& column : snapshot.columns)
    if (column.name == "gap") {
      EXPECT_EQ(std::get<std::vector<double>>(column.values)[1], 1e-13);
    }
  EXPECT_EQ(run.attempts.size(), 1U);
}

// A column that amplifies rounding: what the run in double has made of it by the end is far from what is proved.
TEST(Agreement, TheFileHasTheProvedNumbers) {
  const Certified run = certified(
      "law = {type = 'inelastic', restitution = 0.99, cutoff = 0.05}\ngravity.acceleration = 0.859\nwalls = {left = "
      "{position = -0.00009349099131}, right = {position = 0.45908214418629509127}}\ninitial = {type = 'list', x = [0, "
      "0.0000000000000000853, 0.1990747710000000853, 0.4590747710000000853, 0.45907477100000009127], v = [-7.8265, "
      "0.886283085324021, 0.0251437835, 6.5937, 0.2], m = [0.0871, 43.0, 3.42, 6.87, 62.7]}\nrun.until = 7\noutput = "
      "{events = true, snapshots = [7]}\n",
      [](RunSample&) {}, [](Result&) {}, cradle::tools::rising_digits());
  ASSERT_TRUE(run.proved());
  const Result result = certified_result(run);
  const auto numbers = [&](const char* group, const char* name) {
    for (const Column& column : result.find(group)->columns)
      if (column.name == name) return std::get<std::vector<double>>(column.values);
    return std::vector<double>();
  };
  for (const char* name : {"gap", "closing_speed"}) {
    const auto number = numbers("snapshots/0000", name),
               low = numbers("certificate/snapshots/0000", (name + std::string("_low")).c_str()),
               high = numbers("certificate/snapshots/0000", (name + std::string("_high")).c_str());
    ASSERT_EQ(number.size(), 4U);
    for (std::size_t j = 0; j < number.size(); ++j) {
      EXPECT_LE(low[j], number[j]) << name << ' ' << j;
      EXPECT_LE(number[j], high[j]) << name << ' ' << j;
    }
  }
}

TEST(Agreement, AnErrorOfARunInDoubleAsksForAWiderOne) {
  const Certified run = certified(shock, [](RunSample& at) {
    if (at.epsilon > 1e-20L) at.energy = moved(at.energy, 1e-9);
  });
  EXPECT_TRUE(run.proved());
  ASSERT_EQ(run.attempts.size(), 2U);
  EXPECT_TRUE(has(run.attempts.front().doubt, "the run's energy is not what is proved of it"));
}

TEST(Agreement, ARunThatEndsBeforeItsTimeIsProvedUpToThere) {
  Certified run;
  run.scene = parse_scene(shock, "shock", {});
  run.certificate.collisions = 7;
  run.certificate.samples.push_back({});
  run.certificate.samples.back().time_text = "3.25";
  run.outcome.end = RunEnd::exhausted;
  EXPECT_FALSE(run.proved());
  EXPECT_TRUE(
      has(certificate_text(run), "undecided from t = 3.25 on, after 7 collisions: the run ended there, before t = 12"));
  run.outcome.end = RunEnd::collapsed;
  EXPECT_TRUE(run.proved());
  EXPECT_TRUE(has(certificate_text(run), "not proved: that this is an inelastic collapse"));
}

}  // namespace agreement_test
