#pragma once

#include <opencv2/core.hpp>

namespace rcme {

// cv::imdecode(bytes, flags). Its library is loaded with the first image, because Debian's depends on over a
// hundred others, whose loading takes longer than most commands. Throws InputError if it cannot be loaded.
// Thread-safe.
cv::Mat DecodeImage(cv::InputArray bytes, int flags);

}  // namespace rcme
