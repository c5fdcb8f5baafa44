#include "tests/fault/lies/lie_cases.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

#include "systems/framework/random.h"
#include "systems/robot/parallel_robot.h"
#include "tests/fault/lies/lie_stage.h"

namespace flinch::test {
namespace {

constexpr Time quick = 5ms, slow = 30ms;  // brakes

using Key = std::tuple<std::string, double, double, bool, bool, Time, bool, unsigned, LieMoment, Time>;
Key key(const LieScene& scene) {
  return {scene.robot,  scene.speed,           scene.direction_deg, scene.passive_encoders, scene.imu,
          scene.brakes, scene.from_standstill, scene.seed,          scene.moment,           scene.period};
}

void add(std::vector<LieCase>& cases, const LieScene& scene, const std::vector<std::string>& lies) {
  for (const std::string& lie : lies) {
    const bool of_passive = lie.find("passive_encoder") != std::string::npos;
    if (scene.passive_encoders || !of_passive) cases.push_back({scene, lie});
  }
}

/// "wrong:0.001" with its size times `scale`; that of the rig as it is written.
std::string sized(const std::string& kind, double scale) {
  const std::size_t at = kind.find(':');
  if (scale == 1.0 || at == std::string::npos) return kind;
  return fmt::format("{}:{:.4g}", kind.substr(0, at), scale * std::stod(kind.substr(at + 1)));
}

/// Whether the size of a lie is that of a reading, not a share or a time.
bool is_a_reading(const std::string& kind) {
  return !kind.starts_with("scaled") && !kind.starts_with("delayed");
}

}  // namespace

std::vector<std::string> lies_of_a_drive(int number, const std::string& robot) {
  const LieStage& stage = lie_stage(robot);
  const std::string n = std::to_string(number);
  std::vector<std::string> lies;
  const auto tell = [&](const std::string& signal, double scale, const std::vector<std::string>& kinds) {
    for (const std::string& kind : kinds)
      lies.push_back(signal + n + ":" + (is_a_reading(kind) ? sized(kind, scale) : kind));
  };
  tell("encoder", stage.angle,
       {"wrong:0.001", "wrong:0.005", "wrong:-0.02", "drifting:11", "drifting:-5", "drifting:1",
        "drifting:0.2", "drifting:0.05", "drifting:0.02", "stuck", "stuck:7e-6", "scaled:0.5", "scaled:2",
        "reversed", "delayed:0.01", "delayed:0.03", "noise:1e-4", "noise:1e-3"});
  tell("current", stage.current,
       {"wrong:0.5", "wrong:-2", "stuck", "scaled:0", "scaled:2", "scaled:0.5", "reversed", "noise:0.5"});
  tell("drive", stage.torque,
       {"off", "stuck", "stuck:50", "stuck:-30", "reversed", "wrong:20", "scaled:0", "scaled:-1",
        "delayed:0.02"});
  if (stage.robot.robot->passive_joints() >= number)
    tell("passive_encoder", 1.0, {"wrong:0.0175", "drifting:0.2", "stuck"});
  return lies;
}

std::vector<std::string> lies_of_all(const std::string& robot) {
  return {"encoders:stuck",
          "encoders:" + sized("stuck:7e-6", lie_stage(robot).angle),
          "encoders:stuck+passive_encoders:stuck",
          "encoders:delayed:0.003",
          "encoders:delayed:0.01",
          "encoders:delayed:0.01+passive_encoders:delayed:0.01",
          "encoders:scaled:0.5",
          "encoders:reversed",
          "currents:stuck",
          "currents:reversed",
          "currents:scaled:2",
          "drives:off",
          "drives:scaled:0",
          "brakes:stuck",
          "status:stuck",
          "gyroscope:wrong:0.5",
          "accelerometer:wrong:20",
          "imu:stuck",
          "passive_encoders:off"};
}

std::vector<LieCase> all_lies() {
  std::vector<LieCase> cases;
  unsigned seed = 1;
  for (const double speed : {0.0, 0.1, 0.3, 0.6, 1.0, 1.4}) {
    for (int drive = 1; drive <= 3; ++drive) {
      const LieScene scene{.speed = speed, .seed = seed++, .brakes = quick};
      add(cases, scene, lies_of_a_drive(drive));
      if (drive == 1) add(cases, scene, lies_of_all());
    }
  }
  for (const double speed : {0.3, 1.4}) {
    for (const bool passive : {true, false}) {
      const LieScene blind{
          .speed = speed, .seed = seed++, .passive_encoders = passive, .imu = false, .brakes = quick};
      add(cases, blind, lies_of_a_drive(2));
      const LieScene early{.speed = speed, .seed = seed++, .brakes = quick, .from_standstill = true};
      add(cases, early, lies_of_a_drive(passive ? 1 : 3));
    }
    const LieScene blind{.speed = speed, .seed = seed++, .passive_encoders = false, .brakes = quick};
    add(cases, blind, lies_of_a_drive(1));
    const LieScene late{.speed = speed, .seed = seed++, .brakes = slow};
    add(cases, late, lies_of_a_drive(3));
    add(cases, late, lies_of_all());
  }
  return cases;
}

std::vector<LieCase> all_lies_of(const std::string& robot) {
  const LieStage& stage = lie_stage(robot);
  const int drives = stage.robot.robot->drives();
  const bool has_passive = stage.robot.robot->passive_joints() > 0;
  std::vector<LieCase> cases;
  unsigned seed = 1;
  const auto add_scene = [&](LieScene scene, int drive) {
    scene.robot = robot;
    scene.passive_encoders = scene.passive_encoders && has_passive;
    scene.direction_deg = 40.0 * drive;
    scene.seed = seed++;
    scene.brakes = quick;
    add(cases, scene, lies_of_a_drive(drive, robot));
    if (drive == 1) add(cases, scene, lies_of_all(robot));
  };
  for (const double speed : {0.0, 0.1, 0.3, 0.5}) {
    for (int drive = 1; drive <= drives; ++drive) add_scene({.speed = speed}, drive);
  }
  for (const double speed : {0.2, 0.5}) {
    add_scene({.speed = speed, .imu = false}, 2);
    add_scene({.speed = speed, .passive_encoders = false}, 1);
    add_scene({.speed = speed, .passive_encoders = false, .imu = false}, 2);
    add_scene({.speed = speed, .from_standstill = true}, 1);
  }
  return cases;
}

std::vector<LieCase> pairs_of_lies(std::size_t count, std::uint64_t seed, const std::string& robot) {
  const LieStage& stage = lie_stage(robot);
  const bool is_rig = robot == "planar_3rrr";
  RandomGenerator random(seed);
  const auto pick = [&random](std::size_t below) {
    return std::min(below - 1, static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(below))));
  };
  std::vector<std::string> lies = lies_of_all(robot);
  for (int drive = 1; drive <= stage.robot.robot->drives(); ++drive) {
    const std::vector<std::string> more = lies_of_a_drive(drive, robot);
    lies.insert(lies.end(), more.begin(), more.end());
  }
  std::vector<LieCase> cases;
  while (cases.size() < count) {
    const std::string first = lies[pick(lies.size())], second = lies[pick(lies.size())];
    if (first.substr(0, first.find(':')) == second.substr(0, second.find(':'))) continue;
    const LieMoment moment = static_cast<LieMoment>(pick(4));
    const bool meets = moment == LieMoment::contact || moment == LieMoment::reaction;
    LieScene scene{.robot = robot,
                   .speed = random.uniform(meets ? 0.3 : 0.05, is_rig ? 1.2 : 0.5),
                   .direction_deg = stage.contact_deg,
                   .seed = static_cast<unsigned>(cases.size() + 1),
                   .passive_encoders = pick(4) > 0,
                   .imu = pick(4) > 0,
                   .brakes = quick,
                   .from_standstill = moment == LieMoment::motion && pick(4) == 0,
                   .moment = moment};
    if (moment == LieMoment::motion && pick(4) == 0) scene.speed = 0.0;
    if (scene.speed == 0.0) scene.from_standstill = false;
    if (stage.robot.robot->passive_joints() == 0) scene.passive_encoders = false;
    const bool of_passive = (first + second).find("passive_encoder") != std::string::npos;
    if (of_passive && !scene.passive_encoders) continue;
    cases.push_back({scene, first + "+" + second});
  }
  return cases;
}

std::vector<LieCase> lies_that_once_passed() {
  const LieScene moving{.speed = 0.3, .brakes = quick};
  const LieScene resting{.speed = 0.0, .brakes = quick};
  std::vector<LieCase> cases;
  add(cases, moving,
      {"encoder3:reversed", "encoder1:drifting:-5", "encoder1:drifting:11", "drive1:reversed",
       "encoders:delayed:0.01+passive_encoders:delayed:0.01",
       "encoders:stuck:7e-6+passive_encoders:stuck:1e-4", "drive1:stuck:50", "drives:off",
       "currents:reversed", "currents:stuck", "passive_encoders:off+encoder1:drifting:0.2"});
  add(cases, resting, {"encoder2:wrong:0.005", "drive1:stuck:50"});
  add(cases, {.speed = 1.0, .brakes = quick}, {"currents:scaled:0.5", "currents:scaled:2", "brakes:stuck"});
  return cases;
}

std::string reason_of_failure(const LieCase& told) {
  const auto tells = [&told](const char* word) { return told.lie.find(word) != std::string::npos; };
  if (tells("drive") && tells("scaled:0"))
    return "a torque that is missing under a current as commanded is told from an obstacle only by the "
           "energy that the robot gets";
  if (tells("drive") && tells("scaled:-1"))
    return "a drive that turns round while something is touched, or another one does, is told only by the "
           "energy that it gives";
  if (!told.scene.passive_encoders && !told.scene.imu && tells("encoder") && tells("stuck"))
    return "an encoder that stands still with its noise is an obstacle to the model, and nothing else sees "
           "the motion";
  if (told.scene.robot == "hexapod_6ups" && tells("encoder"))
    return "a hexapod has no passive encoders, and its IMU is left out where cogging shakes it: nothing else "
           "sees the motion";
  if (told.scene.robot == "five_bar" && tells("drive") && tells("reversed"))
    return "in the 3 ms until it is named a drive that is turned round gives so light a robot 0.3 m/s";
  if (!told.scene.passive_encoders && tells("encoder") && tells("+encoder"))
    return "of two encoders that lie at once the passive ones would tell, which are not there";
  if (tells("brakes:stuck"))
    return "what holds the drives is an obstacle until a torque has changed and nothing has moved for 32 ms";
  if (told.scene.brakes >= slow)
    return "until slow brakes have closed the robot coasts, where the honest one would slow down by its "
           "drives";
  return "";
}

std::vector<LieOutcome> try_all(const std::vector<LieCase>& cases) {
  std::map<Key, std::shared_future<LieRun>> honest;
  std::mutex mutex;
  std::atomic<std::size_t> next = 0;
  std::vector<LieOutcome> outcomes(cases.size());
  const auto work = [&] {
    for (std::size_t i = next++; i < cases.size(); i = next++) {
      std::shared_future<LieRun> run;
      {
        const std::lock_guard lock(mutex);
        auto& known = honest[key(cases[i].scene)];
        if (!known.valid()) known = std::async(std::launch::deferred, honest_run, cases[i].scene).share();
        run = known;
      }
      outcomes[i] = try_lie(cases[i].scene, cases[i].lie, run.get());
    }
  };
  auto other = std::async(std::launch::async, work);
  work();
  other.get();
  return outcomes;
}

}  // namespace flinch::test
