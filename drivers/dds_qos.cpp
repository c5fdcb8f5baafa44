#include "drivers/dds_qos.h"

#include <dds/dds.h>

namespace flinch {

void DeleteQos::operator()(dds_qos* qos) const noexcept { dds_delete_qos(qos); }

DdsQos qos_of(TopicKind kind) {
  DdsQos qos(dds_create_qos());
  const bool periodic = kind == TopicKind::sensor || kind == TopicKind::command;
  dds_qset_reliability(qos.get(), periodic ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kind == TopicKind::event ? 100 : 1);
  if (periodic) dds_qset_deadline(qos.get(), DDS_MSECS(5));
  if (kind == TopicKind::command) {
    dds_qset_lifespan(qos.get(), DDS_MSECS(5));
    dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_MSECS(20));
  }
  if (kind == TopicKind::request) dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  return qos;
}

}  // namespace flinch
