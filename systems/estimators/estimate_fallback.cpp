#include "systems/estimators/estimate_fallback.h"

namespace flinch {

void EstimateFallback::choose(const WrenchEstimate& wanted, const WrenchEstimate& instead,
                              WrenchEstimate& result) const {
  result = wanted.valid ? wanted : instead;
  if (wanted.valid) return;
  result.health = wanted.health;  // why
  result.health.fallen_back = true;
}

}  // namespace flinch
