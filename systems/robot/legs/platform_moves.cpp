#include "systems/robot/legs/platform_moves.h"

#include <algorithm>

namespace flinch {
namespace {

using Kind = ConfigurationSpace::Kind;
constexpr ChartRole fixed = ChartRole::fixed;
constexpr ChartRole moves = ChartRole::free;

struct Word {
  const char* name;
  PlatformMoves moves;
};

const std::array<Word, 4>& words() {
  static const std::array<Word, 4> all{
      {{"plane", {Kind::plane, {moves, moves, fixed, fixed, fixed, fixed}, true}},
       {"translation", {Kind::space, {moves, moves, moves, fixed, fixed, fixed}, false}},
       {"planar_pose", {Kind::planar_pose, {moves, moves, fixed, fixed, fixed, moves}, true}},
       {"spatial_pose", {Kind::spatial_pose, {moves, moves, moves, moves, moves, moves}, false}}}};
  return all;
}

}  // namespace

int PlatformMoves::following() const {
  return static_cast<int>(std::count(roles.begin(), roles.end(), ChartRole::follows));
}

std::vector<std::string> moves_words() {
  std::vector<std::string> names;
  for (const Word& word : words()) names.emplace_back(word.name);
  return names;
}

PlatformMoves moves_of(const std::string& word) {
  const auto found =
      std::find_if(words().begin(), words().end(), [&](const Word& one) { return one.name == word; });
  return found == words().end() ? PlatformMoves{} : found->moves;
}

// In the plane of x and y the platform may turn as they say.
std::optional<PlatformMoves> moves_of(const std::array<ChartRole, 6>& roles) {
  if (roles == std::array<ChartRole, 6>{moves, moves, fixed, fixed, fixed, ChartRole::follows})
    return PlatformMoves{Kind::plane, roles, true};
  for (const Word& word : words()) {
    if (word.moves.planar) continue;
    bool same = true;
    for (std::size_t i = 0; i < 6; ++i) same = same && (roles[i] == moves) == (word.moves.roles[i] == moves);
    if (same) return PlatformMoves{word.moves.space, roles, false};
  }
  return std::nullopt;
}

}  // namespace flinch
