#pragma once

#include <mutex>
#include <string_view>

#include "apps/flinch/bus/operator_console.h"

namespace flinch {

/// Orders that somebody gives on a page, for the operator's console while there is one. Of any thread.
class OrdersFromPage {
 public:
  /// False: it is no order, or nobody takes it.
  bool follow(std::string_view order) {
    const std::lock_guard lock(mutex_);
    return console_ != nullptr && console_->follow(order);
  }

  /// Who takes them from now on; null: nobody. It must outlive that.
  void reach(OperatorConsole* console) {
    const std::lock_guard lock(mutex_);
    console_ = console;
  }

 private:
  std::mutex mutex_;
  OperatorConsole* console_ = nullptr;
};

}  // namespace flinch
