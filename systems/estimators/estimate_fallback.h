#pragma once

#include "systems/framework/system.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Passes an estimate on as long as it is valid; in the tick in which it is not, and until it is again, that
/// of an estimator which needs less, and says so.
class EstimateFallback final : public System {
 public:
  InputPort<WrenchEstimate> preferred = input<WrenchEstimate>("preferred");
  InputPort<WrenchEstimate> other = input<WrenchEstimate>("other");
  OutputPort<WrenchEstimate> wrench = output<&EstimateFallback::choose>("wrench", preferred, other);

 private:
  void choose(const WrenchEstimate& wanted, const WrenchEstimate& instead, WrenchEstimate& result) const;
};

}  // namespace flinch
