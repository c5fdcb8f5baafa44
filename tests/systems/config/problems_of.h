#pragma once

#include <functional>
#include <string>
#include <vector>

#include "systems/config/config_reader.h"
#include "tests/support/problems_of.h"

namespace flinch::test {

using Problems = std::vector<std::string>;

using test::problems_of;

/// What is wrong with `text`, which comes from "a.yaml", for a reader that wants what `read` reads.
inline Problems problems_of(const std::string& text, const std::function<void(ConfigReader&)>& read) {
  return problems_of([&] {
    ConfigReader reader = ConfigReader::parse(text, "a.yaml");
    read(reader);
    reader.finish();
  });
}

}  // namespace flinch::test
