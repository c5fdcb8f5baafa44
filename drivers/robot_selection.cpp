#include "drivers/robot_selection.h"

#include <algorithm>
#include <cstring>

namespace flinch {
namespace {

constexpr Time remembered = 1s;

bool is_gone(std::int64_t last_ns, Time now) { return now - Time(last_ns) > remembered; }

std::string name_of(std::array<char, longest_robot_name> letters) {
  const std::string name(letters.begin(), std::find(letters.begin(), letters.end(), '\0'));
  return problems_of_robot_name(name).empty() ? name : "";
}

}  // namespace

RobotSelection::RobotSelection(std::string wanted, Time discovery)
    : wanted_(std::move(wanted)), discovery_(discovery) {}

RobotSelection::Seen* RobotSelection::find(std::uint64_t id) noexcept {
  for (Seen& seen : seen_) {
    if (seen.id.load() == id) return &seen;
  }
  return nullptr;
}

RobotSelection::Seen* RobotSelection::place_for(std::uint64_t id, Time now) noexcept {
  if (Seen* const known = find(id)) return known;
  for (Seen& seen : seen_) {
    std::uint64_t before = seen.id.load();
    if (before != 0 && (before == taken() || !is_gone(seen.last_ns.load(), now))) continue;
    seen.first_ns = seen.last_ns = now.count();
    if (!seen.id.compare_exchange_strong(before, id)) {
      if (before == id) return &seen;
      continue;
    }
    for (auto& word : seen.name) word = 0;
    return &seen;
  }
  return nullptr;
}

bool RobotSelection::admits(std::uint64_t id, Time now) noexcept {
  if (id == 0) return false;
  Seen* const seen = place_for(id, now);
  if (seen == nullptr) return id == taken();
  if (is_gone(seen->last_ns.exchange(now.count()), now)) seen->first_ns = now.count();
  std::uint64_t before = taken();
  if (before != 0 && id != before && succeeds(*seen, before, now)) taken_.compare_exchange_strong(before, id);
  if (taken() != 0) return id == taken();
  const Candidates found = candidates(now);
  return found.count == 1 && found.id == id;
}

void RobotSelection::note_name(std::uint64_t id, const std::uint8_t* name) noexcept {
  Seen* const seen = id == 0 ? nullptr : find(id);
  if (seen == nullptr) return;
  std::array<std::uint64_t, words> told{};
  std::memcpy(told.data(), name, longest_robot_name);
  for (std::size_t i = 0; i < words; ++i) seen->name[i] = told[i];
}

RobotSelection::Candidates RobotSelection::candidates(Time now) const noexcept {
  Candidates found;
  std::array<std::uint64_t, most_robots> counted{};  // two threads may have noted a new one at once
  for (const Seen& seen : seen_) {
    const std::uint64_t id = seen.id.load();
    if (id == 0 || is_gone(seen.last_ns.load(), now) || !may_be_meant(id)) continue;
    if (std::find(counted.begin(), counted.end(), id) != counted.end()) continue;
    counted[static_cast<std::size_t>(found.count)] = id;
    found = {.count = found.count + 1, .id = id, .first = Time(seen.first_ns.load())};
  }
  return found;
}

/// Whether a robot is `before`, which was taken, started again. Of one without a name nothing tells so.
bool RobotSelection::succeeds(const Seen& seen, std::uint64_t before, Time now) noexcept {
  const std::uint64_t id = seen.id.load();
  if (is_robot_id(wanted_) || !have_one_name(id, before)) return false;
  const Seen* const silent = find(before);
  if (silent == nullptr) return false;
  const std::int64_t end_ns = silent->last_ns.load();
  const bool after = seen.first_ns.load() > end_ns && now - Time(end_ns) > discovery_;
  return after && std::none_of(seen_.begin(), seen_.end(), [&](const Seen& other) {
           const std::uint64_t another = other.id.load();
           const bool there = other.last_ns.load() > end_ns && !is_gone(other.last_ns.load(), now);
           return another != id && have_one_name(another, id) && there;
         });
}

std::uint64_t RobotSelection::take(Time now) noexcept {
  if (taken() != 0) return taken();
  const Candidates found = candidates(now);
  if (found.count != 1) return 0;
  if (!is_robot_id(wanted_) && now - found.first < discovery_) return 0;
  std::uint64_t none = 0;
  taken_.compare_exchange_strong(none, found.id);
  return taken();
}

bool RobotSelection::is_undecided(Time now) const noexcept {
  return taken() == 0 && candidates(now).count > 1;
}

int RobotSelection::count() const noexcept {
  return static_cast<int>(
      std::count_if(seen_.begin(), seen_.end(), [](const Seen& seen) { return seen.id.load() != 0; }));
}

std::vector<SeenRobot> RobotSelection::robots() const {
  std::vector<SeenRobot> found;
  for (const Seen& seen : seen_) {
    const std::uint64_t id = seen.id.load();
    if (id == 0) continue;
    std::array<std::uint64_t, words> told{};
    for (std::size_t i = 0; i < words; ++i) told[i] = seen.name[i];
    std::array<char, longest_robot_name> letters{};
    std::memcpy(letters.data(), told.data(), letters.size());
    found.push_back({.id = id, .name = name_of(letters)});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  const auto end = std::unique(found.begin(), found.end(), [](auto& a, auto& b) { return a.id == b.id; });
  found.erase(end, found.end());
  return found;
}

}  // namespace flinch
