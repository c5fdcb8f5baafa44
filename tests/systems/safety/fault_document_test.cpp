#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <string>
#include <vector>

#include "systems/safety/fault_table.h"

namespace flinch {
namespace {

using testing::StartsWith;

/// The rows of docs/faults.md that begin with a number.
std::vector<std::string> documented_rows() {
  std::ifstream document(FLINCH_SOURCE_DIR "/docs/faults.md");
  std::vector<std::string> rows;
  for (std::string line; std::getline(document, line);) {
    const bool numbered = line.size() > 2 && std::isdigit(static_cast<unsigned char>(line[2])) != 0;
    if (line.starts_with("| ") && numbered) rows.push_back(line);
  }
  return rows;
}

std::string in_words(Doubt doubt) {
  switch (doubt) {
    case Doubt::nothing:
      return "";
    case Doubt::time:
      return "time";
    case Doubt::angles:
      return "angles";
    case Doubt::rates:
      return "rates";
    case Doubt::drives:
      return "drives";
    case Doubt::currents:
      return "currents";
    case Doubt::laws:
      return "laws";
  }
  return "?";
}

std::string document(const FaultRow& row) {
  const bool stops = row.reaction() == GateReaction::controlled_stop;
  return "| " + std::to_string(static_cast<int>(row.fault)) + " | " + row.description + " | " +
         (stops ? "controlled stop" : "no torque, brakes") + " | " + in_words(row.doubt) + " | " +
         std::to_string(row.latency) + " ms |";
}

TEST(FaultDocument, HasTheRowsOfTheFaultTable) {
  const std::vector<std::string> rows = documented_rows();
  ASSERT_EQ(rows.size(), fault_table().size());
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_THAT(rows[i], StartsWith(document(fault_table()[i])));
}

}  // namespace
}  // namespace flinch
