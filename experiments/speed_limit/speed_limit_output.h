#pragma once

#include <string>
#include <vector>

namespace flinch {

struct SpeedLimit;
struct SpeedLimitStudy;

/// The answer in one sentence: the lowest of all limits that a force sets, with its place, and what is not
/// known.
std::string speed_limit_sentence(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits);

/// The map as a table for people: a row for each body and place, a column for each direction.
std::string speed_limit_table(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits);

/// The same as one JSON object on one line: {"cells": [{"x_m", "y_m", "direction_deg", "body",
/// "speed_m_per_s", "confidence"}], "summary"}. A speed of 0: the slowest that was tried is too fast; null:
/// the body cannot be run into anything there. Without a speed the confidence is null.
std::string speed_limit_json(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits);

}  // namespace flinch
