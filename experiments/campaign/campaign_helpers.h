#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "experiments/campaign/run_result.h"

namespace flinch {

struct Campaign;

/// Other programs that work on the same campaign. One of all leads: it has the journal and writes the tables.
/// The others do runs whose numbers it hands out.
class CampaignHelpers {
 public:
  using NextRun = std::function<std::optional<std::size_t>()>;
  using TakeResult = std::function<void(const RunResult&)>;

  virtual ~CampaignHelpers() = default;

  /// Whether this program is the one that leads.
  virtual bool leads() const = 0;

  /// Where this program does not lead: does runs until there are none left.
  virtual void work(const Campaign& campaign) = 0;

  /// Where it leads: answers all that ask for a run, with that of `next`, and takes the results that have
  /// come. Returns at once where nobody has said anything. Throws SetupError for a run that cannot be made.
  virtual void serve(const NextRun& next, const TakeResult& take) = 0;
};

}  // namespace flinch
