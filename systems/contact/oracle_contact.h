#pragma once

#include "systems/framework/system.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_location.h"

namespace flinch {

/// Hands on what somebody says who knows what touches the robot: an experiment whose contact is known from
/// the start. It stands in the place of a classifier and a locator where these are not what is examined.
class OracleContact final : public System {
 public:
  InputPort<ContactClassification> told_classification = input<ContactClassification>("told_classification");
  InputPort<ContactLocation> told_location = input<ContactLocation>("told_location");
  OutputPort<ContactClassification> classification =
      output<&OracleContact::pass_classification>("classification", told_classification);
  OutputPort<ContactLocation> location = output<&OracleContact::pass_location>("location", told_location);

 private:
  ContactClassification pass_classification(const ContactClassification& told) const { return told; }
  ContactLocation pass_location(const ContactLocation& told) const { return told; }
};

}  // namespace flinch
