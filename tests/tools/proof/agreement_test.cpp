// A proof and its run that do not agree: an error planted in any quantity that the run reports, in every precision,
// ends the program with the name of the quantity, and never gives a certificate.
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
  void check_beside() override { proof_->check_beside(); }
  void check_all() override { proof_->check_all(); }
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

const Plant no_plant = [](RunSample&) {};

Certified certified(
    const std::string& toml, const Plant& plant = no_plant, const PlantInFile& in_file = [](Result&) {},
    const std::vector<unsigned>& tried = {31}) {
  const auto make = [&](const Scene& scene, unsigned digits) {
    return std::make_unique<Tampered>(certifier(scene, digits), plant, in_file);
  };
  return certify(parse_scene(toml, "shock"), {.digits = tried, .progress = Progress::Show::never, .make = make});
}

const char* const between_walls = R"(
law = {type = "inelastic", restitution = 0.9, cutoff = 0.1}
initial = {type = "list", x = [1, 2, 3, 4], v = [1, -1, 0.5, 0], m = [1, 2, 1, 1]}
walls.left = {position = 0, temperature = 1}
walls.right = {position = 5, speed = 0.01, restitution = 0.8}
run.until = 20
output.series = {points = 4}
)";

// A number that the run has not had.
struct Planted final : ExactNumber {
  explicit Planted(std::string text) : text_(std::move(text)) {}
  std::string text() const override { return text_; }
  bool is_less(const ExactNumber&) const override { return false; }
  std::string text_;
};
Number planted(const std::string& text) { return {0, std::make_shared<Planted>(text)}; }

void move(std::string& number, double by) { number = to_text(from_text<double_double>(number) + double_double(by)); }
void move(Number& number, double by) {
  std::string text = number.text();
  move(text, by);
  number = planted(text);
}
void move(std::optional<Number>& number, double by) {
  if (number) move(*number, by);
}

TEST(Agreement, OfAProofAndItsRun) {
  const Certified run = certified(shock);
  EXPECT_TRUE(run.proved());
  EXPECT_EQ(run.attempts.size(), 1U);
  EXPECT_GT(run.certificate.collisions, 50U);
}

// Errors in one number of the samples after a time.
template <class Of> Plant in_sample(Of SampledState::*number, double by, double after = -1) {
  return [=](RunSample& at) {
    if (at.time.meant.value > after) move(at.state.*number, by);
  };
}
Plant in_wall(std::size_t side, Number SampledState::Wall::*number, double by) {
  return [=](RunSample& at) {
    if (at.time.meant.value > 19) move(at.state.walls[side].*number, by);
  };
}
Plant in_snapshot(ParticleIndex particle, std::vector<std::string> SampledParticles::*decimals, double by) {
  return [=](RunSample& at) {
    for (std::size_t j = 0; j < (at.particles.*decimals).size(); ++j)
      if (at.particles.index[j] == particle) move((at.particles.*decimals)[j], by);
  };
}
Plant in_count(std::uint64_t Counts::*count) {
  return [=](RunSample& at) { at.state.counts.*count += at.time.meant.value > 11; };
}
Plant another_index(ParticleIndex index) {
  return [=](RunSample& at) { std::ranges::replace(at.particles.index, 8, index); };
}

TEST(Agreement, WhateverIsPlantedIsFoundAndNamed) {
  EXPECT_TRUE(certified(between_walls).proved());
  const struct {
    const char *scene, *quantity;
    Plant plant;
  } plants[] = {
      {shock, "front_left", in_sample(&SampledState::front_left, 1e-9)},
      {shock, "front_right", in_sample(&SampledState::front_right, -1e-9, 11)},
      {shock, "front_left",
       [](RunSample& at) {
         if (at.time.meant.value > 11) at.state.front_left.reset();
       }},
      {shock, "front_right",
       [](RunSample& at) {
         if (at.time.meant.value == 0) at.state.front_right = planted("1");
       }},
      {shock, "energy", in_sample(&SampledState::energy, 1e-10)},
      {shock, "energy",
       [](RunSample& at) {
         if (at.time.meant.value > 3) at.state.energy = planted("nan");
       }},
      {shock, "collisions", in_count(&Counts::collisions)},
      {shock, "collisions_below_cutoff", in_count(&Counts::below_cutoff)},
      {shock, "merges", in_count(&Counts::merges)},
      {shock, "time of the sample", [](RunSample& at) { move(at.time.exact, 1e-12 * (at.time.meant.value > 3)); }},
      {shock, "x of particle 7 in the snapshot", in_snapshot(7, &SampledParticles::x, 1e-9)},
      {shock, "v of particle 12 in the snapshot", in_snapshot(12, &SampledParticles::v, 1e-10)},
      {shock, "m of particle 9 in the snapshot", in_snapshot(9, &SampledParticles::m, 1e-10)},
      {shock, "of particle 8 in the snapshot", another_index(-1)},
      {shock, "in one cluster", another_index(7)},
      {between_walls, "energy given by the left wall", in_wall(0, &SampledState::Wall::given, 1e-9)},
      {between_walls, "momentum given by the left wall", in_wall(0, &SampledState::Wall::momentum, 1e-9)},
      {between_walls, "energy given by the right wall", in_wall(1, &SampledState::Wall::given, -1e-9)},
      {between_walls, "momentum given by the right wall", in_wall(1, &SampledState::Wall::momentum, 1e-9)},
      {between_walls, "energy lost in the right wall", in_wall(1, &SampledState::Wall::dissipated, 1e-9)},
      {between_walls, "energy lost in the left wall", in_wall(0, &SampledState::Wall::dissipated, 1e-9)},
      {between_walls, "collisions with the right wall",
       [](RunSample& at) { at.state.walls[1].collisions += at.time.meant.value > 19; }}};
  for (const auto& [scene, quantity, plant] : plants) {
    const std::string message =
        cradle::tests::refusal(Exit::lost, [&scene = scene, &plant = plant] { certified(scene, plant); });
    EXPECT_TRUE(has(message, "do not agree")) << quantity;
    EXPECT_TRUE(has(message, quantity));
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
    const Certified run = certified(scene);
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
              for (double& number : std::get<std::vector<double>>(column.values)) number += 1e-10;
      };
      const std::string message = cradle::tests::refusal(Exit::lost, [&] { certified(scene, no_plant, plant); });
      if (has(message, " of /" + path)) found.insert(path);
    }
  }
  std::set<std::string> all = {"events/closing_speed", "events/interval", "events/time"};
  for (const char* column : {"energy", "energy_lost", "front_left", "front_right", "time", "wall_left_energy",
                             "wall_left_momentum", "wall_right_energy", "wall_right_lost", "wall_right_momentum"})
    all.insert("series/" + std::string(column));
  for (const char* column : {"x", "v", "m", "gap", "closing_speed"})
    for (const char* snapshot : {"snapshots/0000/", "snapshots/0001/"}) all.insert(snapshot + std::string(column));
  EXPECT_EQ(found, all);
}

// A gap of 1e-13 at x = 1000 is not the difference of its positions as doubles, 1.137e-13.
TEST(Agreement, SmallGapsFarFromTheOriginAreWhatIsProved) {
  const Certified run = certified("law = {type = 'inelastic', restitution = 0.5}\ninitial = {type = 'list', x = [999, "
                                  "1000, 1000.0000000000001], v = [1, 0, 0]}\nrun.until = 3\noutput = {events = true, "
                                  "snapshots = [0]}\n");
  ASSERT_TRUE(run.proved());
  EXPECT_EQ(cradle::tests::numbers(run.outcome.result, "snapshots/0000", "gap")[1], 1e-13);
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
      no_plant, [](Result&) {}, rising_digits());
  ASSERT_TRUE(run.proved());
  const Result result = certified_result(run);
  for (const std::string name : {"gap", "closing_speed"}) {
    const auto number = cradle::tests::numbers(result, "snapshots/0000", name),
               low = cradle::tests::numbers(result, "certificate/snapshots/0000", name + "_low"),
               high = cradle::tests::numbers(result, "certificate/snapshots/0000", name + "_high");
    ASSERT_EQ(number.size(), 4U);
    for (std::size_t j = 0; j < number.size(); ++j) {
      EXPECT_LE(low[j], number[j]) << name << ' ' << j;
      EXPECT_LE(number[j], high[j]) << name << ' ' << j;
    }
  }
}

TEST(Agreement, AnErrorOfARunInDoubleAsksForAWiderOne) {
  const Certified run = certified(shock, [](RunSample& at) {
    if (at.epsilon > 1e-20L) move(at.state.energy, 1e-9);
  });
  EXPECT_TRUE(run.proved());
  ASSERT_EQ(run.attempts.size(), 2U);
  EXPECT_TRUE(has(run.attempts.front().doubt, "the run's energy is not what is proved of it"));
}

// Three meet at one time, and the run fails before anybody asks whether that is decided.
TEST(Agreement, TheErrorOfARunComesAfterTheCollisionsThatItHasMade) {
  const Certified run = certified("law = {type = 'inelastic', restitution = 0.9, cutoff = 0.01}\ninitial = {type = "
                                  "'list', x = [-1, 0, 1], v = [1, 0, -1]}\nrun.until = 30\n",
                                  [](const RunSample& at) {
                                    if (at.time.meant.value > 1) throw Error("a guard of the run");
                                  });
  EXPECT_TRUE(cradle::test::begins(run.undecided(),
                                   "at t = 1, after 1 collisions, particles 1 and 2: open whether they meet after "
                                   "the last collision of either"));
}

TEST(Agreement, ARunThatEndsBeforeItsTimeIsProvedUpToThere) {
  Certified run;
  run.scene = parse_scene(shock, "shock");
  run.certificate.collisions = 7;
  run.certificate.samples.push_back({});
  run.certificate.samples.back().time_text = "3.25";
  run.outcome.end = RunEnd::exhausted;
  EXPECT_FALSE(run.proved());
  EXPECT_TRUE(
      has(certificate_text(run), "undecided from t = 3.25 on, after 7 collisions: the run ended there, before t = 12"));
  run.outcome.end = RunEnd::collapsed;
  EXPECT_TRUE(run.proved());
  EXPECT_TRUE(has(certificate_text(run), "not proved: that infinitely many collisions follow"));
}

}  // namespace agreement_test
