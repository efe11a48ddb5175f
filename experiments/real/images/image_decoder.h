#pragma once

#include <opencv2/core.hpp>

namespace rcme {

// cv::imdecode(bytes, flags). Its library is loaded with the first image: Debian's brings over a hundred
// others along, whose loading takes longer than most commands. Throws InputError where it cannot be loaded.
// Safe from several threads.
cv::Mat DecodeImage(cv::InputArray bytes, int flags);

}  // namespace rcme
