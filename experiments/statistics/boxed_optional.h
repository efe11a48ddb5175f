// An optional value on the heap. It takes eight bytes in each of millions of rows, few of which have a
// value.
#pragma once

#include <memory>
#include <utility>

namespace rcme {

template <typename T>
class BoxedOptional {
 public:
  BoxedOptional() = default;
  BoxedOptional(T value) : value_(std::make_unique<T>(std::move(value))) {}
  BoxedOptional(const BoxedOptional& other) : value_(other ? std::make_unique<T>(*other) : nullptr) {}
  BoxedOptional(BoxedOptional&&) noexcept = default;
  BoxedOptional& operator=(BoxedOptional other) noexcept {
    value_ = std::move(other.value_);
    return *this;
  }

  explicit operator bool() const { return value_ != nullptr; }
  bool has_value() const { return value_ != nullptr; }
  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  // Throws std::bad_optional_access if there is no value.
  const T& value() const { return value_ ? *value_ : throw std::bad_optional_access(); }

 private:
  std::unique_ptr<T> value_;
};

}  // namespace rcme
