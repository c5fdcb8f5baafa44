#include "systems/framework/block_profile.h"

#include <algorithm>

#include "systems/framework/diagram.h"

namespace flinch {

BlockProfile::BlockProfile(const Diagram& diagram, Now now) : now_(now) { collect(diagram, ""); }

void BlockProfile::collect(const Diagram& diagram, const std::string& prefix) {
  for (const auto& child : diagram.children()) {
    if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) {
      collect(*nested, prefix + child->name() + "/");
      continue;
    }
    index_[child.get()] = entries_.size();
    entries_.push_back({{prefix + child->name()}});
  }
}

void BlockProfile::end_call(const System& block) {
  const Time now = now_();
  entries_[index_.at(&block)].in_this_tick += now - last_;
  last_ = now;
}

void BlockProfile::end_tick() {
  ++ticks_;
  for (Entry& entry : entries_) {
    entry.row.worst = std::max(entry.row.worst, entry.in_this_tick);
    entry.row.total += entry.in_this_tick;
    entry.in_this_tick = Time::zero();
  }
}

std::vector<BlockProfile::Row> BlockProfile::rows() const {
  std::vector<Row> rows;
  for (const Entry& entry : entries_) rows.push_back(entry.row);
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.worst > b.worst; });
  return rows;
}

}  // namespace flinch
