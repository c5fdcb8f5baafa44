#include "drivers/dds_reader.h"

#include <dds/dds.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dds_qos.h"

namespace flinch {

bool DdsArrivals::take(void* sample) noexcept {
  dds_sample_info_t info{};
  while (dds_take(reader_, &sample, &info, 1, 1) == 1) {
    if (info.valid_data) return true;
  }
  return false;
}

/// What the bus calls, on its threads.
struct DdsReader::Listener {
  static void arrived(std::int32_t reader, void* self) {
    const DdsReader& receiver = *static_cast<const DdsReader*>(self);
    receiver.on_data_(DdsArrivals(reader), receiver.owner_);
  }

  static void deadline_missed(std::int32_t, dds_requested_deadline_missed_status_t status, void* self) {
    static_cast<DdsReader*>(self)->deadlines_.store(status.total_count, std::memory_order_relaxed);
  }

  static void liveliness_changed(std::int32_t, dds_liveliness_changed_status_t status, void* self) {
    if (status.alive_count_change >= 0) return;
    const auto silent = static_cast<std::uint32_t>(-status.alive_count_change);
    static_cast<DdsReader*>(self)->silences_.fetch_add(silent, std::memory_order_relaxed);
  }
};

DdsReader::DdsReader(const DdsBus& bus, const Topic& topic, OnData on_data, void* owner)
    : on_data_(on_data), owner_(owner) {
  const std::string what = std::string("the topic ") + topic.name;
  const DdsQos qos = qos_of(topic.kind);
  const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(this),
                                                                            dds_delete_listener);
  dds_lset_data_available(listener.get(), &Listener::arrived);
  dds_lset_requested_deadline_missed(listener.get(), &Listener::deadline_missed);
  dds_lset_liveliness_changed(listener.get(), &Listener::liveliness_changed);
  topic_ = DdsEntity(
      check_dds(dds_create_topic(bus.participant(), topic.type, topic.name, nullptr, nullptr), what));
  reader_ = DdsEntity(
      check_dds(dds_create_reader(bus.participant(), topic_.handle(), qos.get(), listener.get()), what));
}

int DdsReader::writers() const noexcept {
  dds_subscription_matched_status_t matched{};
  if (dds_get_subscription_matched_status(reader_.handle(), &matched) != 0) return 0;
  return static_cast<int>(matched.current_count);
}

int writers_on(const DdsBus& bus, const Topic& topic) {
  constexpr std::size_t most = 1000;
  const DdsEntity reader(
      dds_create_reader(bus.participant(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
  std::vector<void*> samples(most, nullptr);
  std::vector<dds_sample_info_t> infos(most);
  const auto count = dds_read(reader.handle(), samples.data(), infos.data(), most, most);
  if (count <= 0) return 0;
  int writers = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const auto& writer = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    const bool is_there = infos[i].valid_data && infos[i].instance_state == DDS_IST_ALIVE;
    if (is_there && std::string_view(writer.topic_name) == topic.name) ++writers;
  }
  dds_return_loan(reader.handle(), samples.data(), count);
  return writers;
}

}  // namespace flinch
