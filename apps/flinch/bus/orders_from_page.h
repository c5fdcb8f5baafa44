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

  /// While it lives, the console takes them. Both must outlive it; null: nobody takes them.
  class Taken {
   public:
    Taken(OrdersFromPage& orders, OperatorConsole* console) : orders_(orders) { orders_.reach(console); }
    Taken(const Taken&) = delete;
    Taken& operator=(const Taken&) = delete;
    ~Taken() { orders_.reach(nullptr); }

   private:
    OrdersFromPage& orders_;
  };

 private:
  void reach(OperatorConsole* console) {
    const std::lock_guard lock(mutex_);
    console_ = console;
  }

  std::mutex mutex_;
  OperatorConsole* console_ = nullptr;
};

}  // namespace flinch
