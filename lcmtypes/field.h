#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace anchord {

/// Where a value stands in a message: a chain on the stack, turned into text such as
/// `detections[3].covariance` only when something is refused. A Field must not outlive its parent.
class Field {
 public:
  /// The message itself.
  Field() = default;

  Field member(std::string_view name) const& { return {this, name, 0}; }
  Field element(std::size_t index) const& { return {this, {}, index}; }
  // A temporary would be gone before its child is.
  Field member(std::string_view name) && = delete;
  Field element(std::size_t index) && = delete;

  std::string text() const {
    if (!parent_) return {};
    std::string path = parent_->text();
    if (name_.data() == nullptr) return path + "[" + std::to_string(index_) + "]";
    if (!path.empty()) path += '.';
    return path.append(name_);
  }

 private:
  Field(const Field* parent, std::string_view name, std::size_t index)
      : parent_(parent), name_(name), index_(index) {}

  const Field* parent_ = nullptr;
  std::string_view name_;  ///< without data for an element
  std::size_t index_ = 0;
};

}  // namespace anchord
