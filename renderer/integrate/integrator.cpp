// SPDX-License-Identifier: Apache-2.0
#include "integrate/integrator.h"

#include "integrate/path_batch.h"

namespace chromeball {

void PathIntegrator::sampleMany(std::span<const CameraSample> cameras, uint32_t firstSample,
                                PathContext& context, std::span<Sample> samples) const {
  thread_local PathBatch batch;
  batch.clear();
  for (const CameraSample& camera : cameras) batch.add(camera.path(), camera.hit);
  batch.trace(tracer_, firstSample, context);
  for (size_t i = 0; i < cameras.size(); ++i) samples[i] = context.clamp(batch.radiance(i));
}

}  // namespace chromeball
