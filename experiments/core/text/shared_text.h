// A text that millions of rows share: a pointer to its only copy, which the program keeps until it ends. Use
// it for names of a few kinds (estimators, quantities), never for texts that may differ in each row.
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace rcme {

class SharedText {
 public:
  SharedText() : SharedText(std::string_view()) {}
  // Converts implicitly from and to a text.
  SharedText(std::string_view text);
  SharedText(const std::string& text) : SharedText(std::string_view(text)) {}
  SharedText(const char* text) : SharedText(std::string_view(text)) {}

  const std::string& text() const { return *text_; }
  operator const std::string&() const { return *text_; }

  friend bool operator==(const SharedText& a, const SharedText& b) { return a.text_ == b.text_; }
  template <std::convertible_to<std::string_view> Text>
  friend bool operator==(const SharedText& a, const Text& b) {
    return std::string_view(*a.text_) == std::string_view(b);
  }

 private:
  const std::string* text_;
};

}  // namespace rcme
