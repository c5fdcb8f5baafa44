#pragma once

#include <string>
#include <vector>

#include "diagrams/stage.h"

namespace flinch {

/// Every stage of one kind in place.
template <class Port>
struct AddedStages {
  std::vector<Named<Port>> all;
  std::string followed;

  const Port& port() const {
    for (const Named<Port>& each : all) {
      if (each.name == followed) return each.port;
    }
    return all.front().port;
  }
  std::vector<Named<Port>> others() const {
    std::vector<Named<Port>> rest;
    for (const Named<Port>& each : all) {
      if (each.name != followed) rest.push_back(each);
    }
    return rest;
  }
};

}  // namespace flinch
