#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/fault/link/link_fault_table.h"

namespace flinch {
namespace {

/// The rows of the first table below the heading, without its own heading.
std::vector<std::string> documented_rows() {
  std::ifstream document(FLINCH_SOURCE_DIR "/docs/faults.md");
  std::string line;
  while (std::getline(document, line) && line != "## Faults of the link and the programs") continue;
  std::vector<std::string> rows;
  while (std::getline(document, line) && (rows.empty() || line.starts_with("| "))) {
    if (line.starts_with("| ")) rows.push_back(line);
  }
  if (rows.size() >= 2) rows.erase(rows.begin(), rows.begin() + 2);
  return rows;
}

std::string document(const test::LinkFault& fault) {
  return std::string("| ") + fault.description + " | " + fault.reaction + " | " +
         (fault.within > 0 ? std::to_string(fault.within) + " ms" : "") + " | `" + fault.name + "` |";
}

TEST(LinkFaultDocument, HasTheRowsOfTheLinkFaultTable) {
  std::vector<std::string> expected;
  for (const test::LinkFault& fault : test::link_fault_table()) expected.push_back(document(fault));
  EXPECT_THAT(documented_rows(), testing::ElementsAreArray(expected));
}

}  // namespace
}  // namespace flinch
