#include "experiments/core/text/shared_text.h"

#include <functional>
#include <mutex>
#include <set>

namespace rcme {
namespace {

const std::string& KeepText(std::string_view text) {
  static std::mutex mutex;
  static std::set<std::string, std::less<>> kept;  // its elements never move
  const std::scoped_lock lock(mutex);
  const auto found = kept.find(text);
  return found != kept.end() ? *found : *kept.emplace(text).first;
}

}  // namespace

SharedText::SharedText(std::string_view text) : text_(&KeepText(text)) {}

}  // namespace rcme
