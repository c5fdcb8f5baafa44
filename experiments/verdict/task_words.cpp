#include "experiments/verdict/task_words.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace flinch {
namespace {

using enum ReactionKind;

constexpr std::array words{"brake", "retreat", "platform", "first_link", "second_link", "opening"};
static_assert(words.size() == static_cast<std::size_t>(opening) + 1);

}  // namespace

const char* word(ReactionKind kind) {
  const auto index = static_cast<std::size_t>(kind);
  return index < words.size() ? words[index] : "unknown";
}

std::string in_words(const FollowedTask& task) {
  const std::string leg = std::to_string(std::int64_t{task.leg} + 1);
  switch (task.kind) {
    case brake:
      return "is braked and yields";
    case retreat:
      return "goes back the way it came, class or direction not known";
    case platform:
      return "moves the platform along the force";
    case first_link:
      return "turns the first link of leg " + leg + " away";
    case second_link:
      return "moves the second link of leg " + leg + " along the force";
    case opening:
      return "opens leg " + leg;
  }
  return "does what is not known";
}

std::vector<FollowedTask> followed_tasks(int legs) {
  std::vector<FollowedTask> tasks;
  for (const ReactionKind kind : {brake, retreat, platform}) tasks.push_back({true, kind, -1});
  for (int leg = 0; leg < legs; ++leg)
    for (const ReactionKind kind : {first_link, second_link, opening}) tasks.push_back({true, kind, leg});
  return tasks;
}

}  // namespace flinch
