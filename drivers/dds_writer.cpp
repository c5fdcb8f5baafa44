#include "drivers/dds_writer.h"

#include <dds/dds.h>

#include <string>

#include "drivers/dds_qos.h"

namespace flinch {

DdsWriter::DdsWriter(const DdsBus& bus, const Topic& topic) {
  const std::string what = std::string("the topic ") + topic.name;
  const DdsQos qos = qos_of(topic.kind);
  topic_ = DdsEntity(
      check_dds(dds_create_topic(bus.participant(), topic.type, topic.name, nullptr, nullptr), what));
  writer_ =
      DdsEntity(check_dds(dds_create_writer(bus.participant(), topic_.handle(), qos.get(), nullptr), what));
}

bool DdsWriter::write(const void* sample) noexcept { return dds_write(writer_.handle(), sample) == 0; }

}  // namespace flinch
