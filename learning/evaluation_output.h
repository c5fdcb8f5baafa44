#pragma once

#include <string>
#include <vector>

#include "learning/evaluation.h"

namespace flinch {

/// An evaluation as tables for people: `all` are those of the other moments, to compare with `chosen`.
std::string evaluation_table(const Evaluation& chosen, const std::vector<Evaluation>& all);

/// As one JSON object on one line. Later versions add keys and rename none.
std::string evaluation_json(const Evaluation& chosen, const std::vector<Evaluation>& all);

}  // namespace flinch
