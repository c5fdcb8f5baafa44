#pragma once

#include <memory>

#include "drivers/topics.h"

struct dds_qos;

namespace flinch {

struct DeleteQos {
  void operator()(dds_qos* qos) const noexcept;
};
using DdsQos = std::unique_ptr<dds_qos, DeleteQos>;

/// The quality of service of all topics of a kind, for writers and readers alike.
DdsQos qos_of(TopicKind kind);

}  // namespace flinch
