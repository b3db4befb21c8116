#include "host/samplers/sampler.h"
namespace nearlight { VplSet sample_close_range(SamplerStages& s, const SamplingTask& t) { return sample_instant_radiosity(s,t);} }
