#pragma once

#include <string>
#include <vector>

#include "tests/fault/lies/lie_trial.h"

namespace flinch::test {

/// A lie in a scene.
struct LieCase {
  LieScene scene;
  std::string lie;
};

/// The lies that are tried of each drive, and of all sensors of a kind together; as large for a robot as its
/// drives are fast and strong, of the rig unless another one is named.
std::vector<std::string> lies_of_a_drive(int number, const std::string& robot = "planar_3rrr");
std::vector<std::string> lies_of_all(const std::string& robot = "planar_3rrr");

/// All of them over drives, speeds, sensors that are mounted, brakes, and begun before the motion: over a
/// thousand.
std::vector<LieCase> all_lies();

/// The same of the robots that are no rig, at the speeds that they reach.
std::vector<LieCase> all_lies_of(const std::string& robot);

/// Two lies at once, `count` times: of all sorts, in motion, at rest, before a motion, in a stop, in a
/// contact that has just begun and in the reaction to it; with and without passive encoders and IMU.
std::vector<LieCase> pairs_of_lies(std::size_t count, std::uint64_t seed,
                                   const std::string& robot = "planar_3rrr");

/// What was once told without being detected, or answered by torque.
std::vector<LieCase> lies_that_once_passed();

/// Why a lie cannot be seen in time, or its answer not be better; empty where it can.
std::string reason_of_failure(const LieCase& told);

/// Tries cases on two threads, in their order.
std::vector<LieOutcome> try_all(const std::vector<LieCase>& cases);

}  // namespace flinch::test
