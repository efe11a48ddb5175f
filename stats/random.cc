#include "stats/random.h"

#include <cmath>
#include <stdexcept>

#include "stats/portable_math.h"

namespace rcme {

std::array<std::uint32_t, 4> Philox4x32(const std::array<std::uint32_t, 4>& counter,
                                        const std::array<std::uint32_t, 2>& key) {
  std::array<std::uint64_t, 2 * kBlocksAtOnce> pairs;
  PhiloxWordPairs({counter, key}, pairs.size(), pairs.data());
  const auto low = [](std::uint64_t pair) { return static_cast<std::uint32_t>(pair); };
  return {low(pairs[0]), low(pairs[0] >> 32), low(pairs[1]), low(pairs[1] >> 32)};
}

RandomStream::RandomStream(const StreamName& name)
    : next_{{0, name.trial, static_cast<std::uint32_t>(name.condition),
             static_cast<std::uint32_t>(name.condition >> 32 << 16) | name.purpose},
            {static_cast<std::uint32_t>(name.seed), static_cast<std::uint32_t>(name.seed >> 32)}} {
  if (name.condition >> 48 != 0) throw std::out_of_range("a stream's condition has at most 48 bits");
  if (name.purpose >> 16 != 0) throw std::out_of_range("a stream's purpose has at most 16 bits");
}

void RandomStream::Refill() {
  PhiloxWordPairs(next_, kNumPairs, pairs_.data());
  next_.counter[0] += kNumPairs / 2;
  num_used_ = 0;
}

double RandomStream::Normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2.0 * PortableLog(1.0 - Uniform()));  // 1 - U is in (0, 1]
  const CosSin direction = PortableCosSinOfTurn(Uniform());
  spare_normal_ = radius * direction.sin;
  has_spare_normal_ = true;
  return radius * direction.cos;
}

void RandomStream::FillUniform(std::span<double> uniforms) {
  // First the rest of the buffer, then whole vectors past the buffer, then the remainder from a new buffer.
  while (!uniforms.empty() && num_used_ < 2 * kNumPairs) {
    uniforms.front() = Uniform();
    uniforms = uniforms.subspan(1);
  }
  const std::size_t num_at_once = uniforms.size() / kUniformsAtOnce * kUniformsAtOnce;
  PhiloxUniforms(next_, num_at_once, uniforms.data());
  next_.counter[0] += static_cast<std::uint32_t>(num_at_once / 2);
  for (double& u : uniforms.subspan(num_at_once)) u = Uniform();
}

void RandomStream::FillNormal(std::span<double> normals) {
  if (has_spare_normal_ && !normals.empty()) {
    normals.front() = Normal();
    normals = normals.subspan(1);
  }
  const std::size_t num_at_once = normals.size() / kUniformsAtOnce * kUniformsAtOnce;
  FillUniform(normals.first(num_at_once));
  NormalsFromUniforms(num_at_once, normals.data());
  for (double& z : normals.subspan(num_at_once)) z = Normal();
}

}  // namespace rcme
