#include "experiments/recorded/measured_contacts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iomanip>
#include <random>

#include "import/imported_recording.h"
#include "plant/contact_truth.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/joint_reading.h"
#include "tests/identification/recorded.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// Two seconds of a force sensor at 1 kHz that shows (5, -3, 80) N at rest; `push` is the force [N] at k ms.
Recording sensed(const std::function<double(std::size_t k)>& push, double noise = 0.05) {
  Recording recording;
  recording.period = 1ms;
  Signal signal{"force_torque", row_layout<ForceTorqueReading>(), {}};
  std::mt19937 generator(7);
  std::normal_distribution<double> normal(0.0, noise);
  for (std::size_t k = 0; k < 2000; ++k) {
    ForceTorqueReading reading;
    const double force = push(k);
    reading.valid = std::isfinite(force);
    reading.force_in_base = {5.0 + 0.6 * force, -3.0 - 0.8 * force, 80.0};
    for (double& component : reading.force_in_base) component += normal(generator);
    recording.time_ns.push_back(static_cast<std::int64_t>(k) * 1'000'000);
    signal.rows.resize((k + 1) * signal.layout.numbers);
    write_row(reading, signal.rows.data() + k * signal.layout.numbers);
  }
  recording.signals.push_back(std::move(signal));
  return recording;
}

double within(std::size_t k, std::size_t from, std::size_t to, double force) {
  return k >= from && k < to ? force : 0.0;
}

TEST(MeasuredContacts, AreThoseThatTheForceShows) {
  // 20 N, with 50 ms without force in between; 12 N; 1.5 N, less than a contact.
  const LogTruth truth = measured_contacts(sensed([](std::size_t k) {
                                             return within(k, 400, 500, 20.0) + within(k, 550, 600, 20.0) +
                                                    within(k, 1000, 1100, 12.0) + within(k, 1500, 1600, 1.5);
                                           }),
                                           std::nullopt, {});
  ASSERT_EQ(truth.contacts.size(), 2U);
  EXPECT_NEAR(truth.contacts[0], 0.399, 1e-9);
  EXPECT_NEAR(truth.contacts[1], 0.999, 1e-9);
  ASSERT_EQ(truth.measured.size(), 2U);
  EXPECT_NEAR(truth.measured[0].to, 0.699, 1e-9);
  EXPECT_NEAR(truth.measured[1].to, 1.199, 1e-9);
  ASSERT_EQ(truth.free.size(), 3U);
  EXPECT_NEAR(truth.free[0].to, 0.399, 1e-9);
  EXPECT_NEAR(truth.free[1].from, 0.700, 1e-9);
  EXPECT_NEAR(truth.free[2].to, 1.999, 1e-9);
}

TEST(MeasuredContacts, BeginWhereASlowRiseLeavesTheNoiseAndEndBelowHalfTheThreshold) {
  // From 0.5 s on 20 N/s up to 10 N, then 10 N/s down to 0 at 2 s.
  const Recording log = sensed([](std::size_t k) {
    const double now = 1e-3 * static_cast<double>(k);
    return now < 0.5 ? 0.0 : std::min(20.0 * (now - 0.5), std::max(0.0, 10.0 - 10.0 * (now - 1.0)));
  });
  const LogTruth truth = measured_contacts(log, 8.0, {{0.0, 0.4}});
  ASSERT_EQ(truth.measured.size(), 1U);
  // Four deviations are 0.2 N, after 10 ms; the noise itself is as large again at the most.
  EXPECT_NEAR(truth.measured[0].from, 0.510, 0.010);
  // 4 N at 1.6 s, then 0.1 s of quiet; noise of 0.05 N makes that uncertain by 20 ms.
  EXPECT_NEAR(truth.measured[0].to, 1.7, 0.020);
}

TEST(MeasuredContacts, TakeTheZeroFromWhatIsSaidToBeFree) {
  const Recording log = sensed([](std::size_t k) { return k < 1500 ? 20.0 : 0.0; });
  EXPECT_NEAR(measured_contacts(log, std::nullopt, {{1.6, 1.9}}).measured.at(0).to, 1.599, 1e-9);
  EXPECT_TRUE(measured_contacts(log, std::nullopt, {{1.6, 1.9}}).contacts.empty());
  const Recording later = sensed([](std::size_t k) { return within(k, 0, 300, 20.0); });
  EXPECT_THAT(test::problems_of([&] { measured_contacts(later, std::nullopt, {}); }),
              Contains(HasSubstr("say by --free A..B where nothing touches")));
}

TEST(MeasuredContacts, AreAboveTheNoiseOfTheSensor) {
  const Recording log = sensed([](std::size_t k) { return within(k, 800, 900, 30.0); }, 1.0);
  const LogTruth truth = measured_contacts(log, std::nullopt, {});
  ASSERT_EQ(truth.contacts.size(), 1U);
  EXPECT_NEAR(truth.contacts[0], 0.799, 0.002);
  EXPECT_THAT(test::problems_of([&] { measured_contacts(log, 2.0, {}); }),
              Contains(HasSubstr("--contact-force: is 2 N; it must be at least")));
}

TEST(MeasuredContacts, LeaveOutWhatTheSensorDoesNotTell) {
  const LogTruth truth = measured_contacts(
      sensed([](std::size_t k) { return k >= 700 && k < 1200 ? std::nan("") : 0.0; }), std::nullopt, {});
  ASSERT_EQ(truth.free.size(), 2U);
  EXPECT_NEAR(truth.free[0].to, 0.699, 1e-9);
  EXPECT_NEAR(truth.free[1].from, 1.2, 1e-9);
}

TEST(MeasuredContacts, RefuseALogWithoutThem) {
  const Recording touched = sensed([](std::size_t k) { return within(k, 400, 500, 20.0); });
  EXPECT_THAT(test::problems_of([&] {
                measured_contacts(touched, std::nullopt, {{0.3, 0.6}});
              }),
              Contains(HasSubstr("which is said to be free")));
  EXPECT_THAT(test::problems_of([&] {
                measured_contacts(touched, std::nullopt, {{3.0, 4.0}});
              }),
              Contains(HasSubstr("no valid sample in what --free marks")));
  Recording without = touched;
  without.signals.clear();
  EXPECT_THAT(test::problems_of([&] { measured_contacts(without, std::nullopt, {}); }),
              Contains(HasSubstr("the log has no force sensor")));
  EXPECT_THAT(test::problems_of(
                  [&] { measured_contacts(sensed([](auto) { return std::nan(""); }), std::nullopt, {}); }),
              Contains(HasSubstr("no sample of the force sensor is valid")));
}

/// A run with joints, currents and the force below the pylon, as a table of another program.
Recording exported(const test::Simulated& run, const test::Workplace& place) {
  std::ofstream out(place / "log.csv");
  out << "t,q1,q2,q3,p1,p2,p3,i1,i2,i3,fx,fy,fz\n" << std::setprecision(17);
  const auto joints = read<JointReading>(run.recording, "joints");
  const auto drives = read<DriveReading>(run.recording, "drives");
  const auto forces = read<ForceTorqueReading>(run.recording, "force_torque");
  for (std::size_t k = 0; k < run.recording.samples(); ++k) {
    const JointReading at = joints[k];
    const DriveReading drive = drives[k];
    const ForceTorqueReading force = forces[k];
    out << 1e-9 * static_cast<double>(run.recording.time_ns[k]);
    for (int i = 0; i < 3; ++i) out << ',' << at.active[i];
    for (int i = 0; i < 3; ++i) out << ',' << at.passive[i];
    for (int i = 0; i < 3; ++i) out << ',' << drive.current[i];
    for (int i = 0; i < 3; ++i) out << ',' << force.force_in_base[i];
    out << '\n';
  }
  out.close();
  std::string mapping =
      "log: log.csv\nscenario: scenarios/platform_collision.yaml\ntime: {column: t, unit: s}\ncolumns:\n";
  const auto add = [&](const std::string& column, const std::string& signal, int entry,
                       const std::string& unit) {
    mapping += "  - {column: " + column + ", signal: " + signal + ", entry: " + std::to_string(entry) +
               ", unit: " + unit + "}\n";
  };
  for (int i = 0; i < 3; ++i) {
    const std::string n = std::to_string(i + 1);
    add("q" + n, "joints.active", i, "rad");
    add("p" + n, "joints.passive", i, "rad");
    add("i" + n, "drives.current", i, "A");
    add(std::string("f") + "xyz"[i], "force_torque.force", i, "N");
  }
  place.write("mapping.yaml", mapping);
  return import_log(place / "mapping.yaml");
}

TEST(MeasuredContacts, BeginWithinASampleOfTheTruth) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const test::Workplace place;
    const test::Simulated run = test::simulated("platform_collision.yaml", {}, seed);
    const auto contacts = read<ContactTruth>(run.recording, "contact");
    double onset = -1.0;
    for (std::size_t k = 0; k < run.recording.samples() && onset < 0.0; ++k) {
      if (contacts[k].in_contact) onset = 1e-9 * static_cast<double>(contacts[k].onset.count());
    }
    ASSERT_GT(onset, 0.0);
    const auto log = std::make_shared<const Recording>(exported(run, place));
    const LogTruth truth = measured_contacts(*log, std::nullopt, {});
    ASSERT_FALSE(truth.contacts.empty());
    EXPECT_NEAR(truth.contacts.front(), onset, 1e-3 + 1e-9) << seed;
    const JudgedLog by_force = judge_log(run.scenario, log, truth);
    const JudgedLog marked = judge_log(run.scenario, log, {{{0.0, onset}}, {onset}});
    const std::string by = by_force.by.front();
    EXPECT_EQ(by_force.false_alarms.at(by), 0U);
    ASSERT_TRUE(by_force.delays.at(by).front().has_value());
    EXPECT_NEAR(*by_force.delays.at(by).front(), *marked.delays.at(by).front(), 1e-3 + 1e-9) << seed;
  }
}

}  // namespace
}  // namespace flinch
