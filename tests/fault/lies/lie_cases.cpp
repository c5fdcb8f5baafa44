#include "tests/fault/lies/lie_cases.h"

namespace flinch::test {

std::vector<std::string> lies_of_a_drive(int number) {
  const std::string n = std::to_string(number);
  std::vector<std::string> lies;
  const auto add = [&](const std::string& signal, const std::vector<std::string>& kinds) {
    for (const std::string& kind : kinds) lies.push_back(signal + n + ":" + kind);
  };
  add("encoder", {"wrong:0.001", "wrong:0.005", "wrong:-0.02", "drifting:11", "drifting:-5", "drifting:1",
                  "drifting:0.2", "drifting:0.05", "drifting:0.02", "stuck", "stuck:7e-6", "scaled:0.5",
                  "scaled:2", "reversed", "delayed:0.01", "delayed:0.03", "noise:1e-4", "noise:1e-3"});
  add("current",
      {"wrong:0.5", "wrong:-2", "stuck", "scaled:0", "scaled:2", "scaled:0.5", "reversed", "noise:0.5"});
  add("drive", {"off", "stuck", "stuck:50", "stuck:-30", "reversed", "wrong:20", "scaled:0", "delayed:0.02"});
  add("passive_encoder", {"wrong:0.0175", "drifting:0.2", "stuck"});
  return lies;
}

std::vector<std::string> lies_of_all() {
  return {"encoders:stuck",
          "encoders:stuck:7e-6",
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
          "gyroscope:wrong:0.5",
          "accelerometer:wrong:20",
          "imu:stuck",
          "passive_encoders:off"};
}

}  // namespace flinch::test
