#include "experiments/real/images/image_decoder.h"

#include <opencv2/imgcodecs.hpp>

#ifdef RCME_IMAGE_LIBRARY
#include <dlfcn.h>
#include <fmt/format.h>

#include "parameters/input_error.h"
#endif

namespace rcme {
namespace {

using Decoder = cv::Mat (*)(cv::InputArray, int);
// Checks that a function of this type exists, as the symbol name below states; this does not link to the
// library.
using Checked = decltype(static_cast<Decoder>(&cv::imdecode));

#ifdef RCME_IMAGE_LIBRARY
Decoder FindDecoder() {
  void* library = dlopen(RCME_IMAGE_LIBRARY, RTLD_LAZY | RTLD_LOCAL);
  void* decoder = library ? dlsym(library, "_ZN2cv8imdecodeERKNS_11_InputArrayEi") : nullptr;
  if (!decoder) throw InputError(fmt::format("no image can be read: {}", dlerror()));
  return reinterpret_cast<Decoder>(decoder);
}
#else
Decoder FindDecoder() { return &cv::imdecode; }
#endif

}  // namespace

cv::Mat DecodeImage(cv::InputArray bytes, int flags) {
  static const Decoder decode = FindDecoder();
  return decode(bytes, flags);
}

}  // namespace rcme
