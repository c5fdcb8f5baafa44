// expect: copies may allocate
// An output that hides a string in one of its parts, which fields() does not show.
#include <string>

#include "systems/framework/system.h"

struct Part {
  double number = 0.0;
#ifndef FLINCH_CONTROL_CASE
  std::string text;
#endif
};

struct Value {
  bool valid = false;
  Part part;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
  }
};

class Block final : public flinch::System {
 public:
  flinch::InputPort<double> in = input<double>("in");
  flinch::OutputPort<Value> out = output<&Block::compute>("out", in);

 private:
  Value compute(double number) const { return {true, {number}}; }
};
