// SPDX-License-Identifier: Apache-2.0 AND BSD-3-Clause
// Mean radiance of the sky by turbidity, albedo, control point and colour channel.
//
// The numbers come from the Hosek-Wilkie sky model [Hosek & Wilkie, An Analytic Model for Full Spectral
// Sky-Dome Radiance, 2012; Adding a Solar-Radiance Function to the Hosek-Wilkie Skylight Model, 2013],
// http://cgg.mff.cuni.cz/projects/SkylightModelling, and are under its licence:
//
// Copyright (c) 2012 - 2013, Lukas Hosek and Alexander Wilkie. All rights reserved.
//
// Redistribution and use in source and binary forms, with or without modification, are permitted provided
// that the following conditions are met:
// - Redistributions of source code must retain the above copyright notice, this list of conditions and the
//   following disclaimer.
// - Redistributions in binary form must reproduce the above copyright notice, this list of conditions and the
//   following disclaimer in the documentation and/or other materials provided with the distribution.
// - None of the names of the contributors may be used to endorse or promote products derived from this
//   software without specific prior written permission.
//
// This software is provided by the copyright holders and contributors "as is" and any express or implied
// warranties, including, but not limited to, the implied warranties of merchantability and fitness for a
// particular purpose are disclaimed. In no event shall the copyright holders be liable for any direct,
// indirect, incidental, special, exemplary, or consequential damages (including, but not limited to,
// procurement of substitute goods or services; loss of use, data, or profits; or business interruption)
// however caused and on any theory of liability, whether in contract, strict liability, or tort (including
// negligence or otherwise) arising in any way out of the use of this software, even if advised of the
// possibility of such damage.
#include "host/scene/sky/sky_data.h"

namespace nearlight::core {

// clang-format off
const float kSkyRadiance[360] = {
  1.96268f, 1.59033f, 0.992652f, 1.15983f, 1.3554f, 1.99949f, 4.45059f, 1.15141f, -4.13611f, 5.07963f, 13.5912f,
  18.5627f, 4.43739f, 5.85771f, 13.5103f, 4.32457f, 8.09083f, 13.9024f, 2.02962f, 1.7117f, 1.1683f, 1.36443f,
  1.65731f, 1.86099f, 4.20153f, 0.932802f, -2.12907f, 5.4151f, 13.1788f, 12.5195f, 9.82584f, 15.0675f, 30.325f,
  10.6333f, 18.6356f, 29.3872f, 1.94649f, 1.55254f, 0.963437f, 1.28751f, 1.51004f, 2.11969f, 3.7037f, 0.127641f,
  -4.61452f, 8.78283f, 16.0464f, 19.197f, 3.44044f, 5.91216f, 13.7664f, 5.16033f, 8.35001f, 14.1873f, 2.02313f,
  1.66697f, 1.15034f, 1.49473f, 1.84999f, 1.91881f, 3.42041f, -0.20886f, -2.41353f, 9.07218f, 15.8665f, 12.7486f,
  9.20516f, 14.8688f, 30.8713f, 11.8664f, 19.4072f, 29.5143f, 1.88217f, 1.47087f, 0.944654f, 1.33588f, 1.88046f,
  2.17161f, 2.64864f, -1.8654f, -4.91556f, 13.5837f, 20.3081f, 19.1824f, 3.10547f, 5.47146f, 15.3713f, 5.90739f,
  9.10983f, 14.0053f, 1.95631f, 1.58485f, 1.11472f, 1.64867f, 2.17002f, 1.96469f, 2.03971f, -2.0196f, -2.62542f,
  14.3024f, 19.7083f, 12.4784f, 9.03953f, 14.9068f, 32.3795f, 13.3045f, 20.4505f, 29.436f, 1.73816f, 1.35656f,
  0.907307f, 1.62429f, 2.37387f, 2.33054f, -0.0087867f, -4.65325f, -5.5776f, 21.1825f, 25.7092f, 19.6162f, 2.77026f,
  5.68601f, 16.8836f, 7.05567f, 10.0948f, 14.4695f, 1.82505f, 1.46941f, 1.07795f, 1.98502f, 2.52402f, 2.00629f,
  -0.803631f, -4.19727f, -2.84693f, 22.0249f, 23.6525f, 11.9019f, 9.41536f, 16.6459f, 34.5929f, 15.1766f, 21.3448f,
  29.3749f, 1.5719f, 1.24423f, 0.873912f, 2.30179f, 2.85152f, 2.38868f, -4.02855f, -7.13094f, -5.843f, 29.6681f,
  29.9345f, 19.2326f, 1.63088f, 6.38212f, 18.8773f, 8.71103f, 11.1458f, 14.857f, 1.65037f, 1.36971f, 1.03514f,
  2.5932f, 2.84355f, 1.98668f, -4.46933f, -6.05903f, -2.75258f, 29.6982f, 26.3499f, 10.6097f, 9.41098f, 18.8136f,
  37.2219f, 17.4485f, 22.3219f, 29.1859f, 1.47505f, 1.17369f, 0.856369f, 2.67909f, 3.1206f, 2.39153f, -6.31131f,
  -8.49189f, -5.76913f, 33.779f, 31.8739f, 18.2871f, 2.14098f, 7.29061f, 20.9721f, 9.38528f, 11.8007f, 14.6959f,
  1.5552f, 1.31048f, 1.01599f, 2.96292f, 2.98444f, 1.99205f, -6.60817f, -6.83169f, -2.81263f, 33.2989f, 26.8234f,
  10.0142f, 10.6456f, 21.2327f, 38.473f, 18.5082f, 22.5975f, 29.2462f, 1.32617f, 1.09184f, 0.827053f, 3.37876f,
  3.36889f, 2.34279f, -9.83144f, -9.72208f, -5.55807f, 39.4206f, 32.6851f, 16.8499f, 2.8527f, 10.3242f, 23.565f,
  10.8254f, 12.3651f, 15.0597f, 1.41248f, 1.22255f, 0.975689f, 3.4394f, 3.17652f, 1.9399f, -9.19662f, -7.7315f,
  -2.53328f, 36.8508f, 26.7176f, 8.31918f, 13.4534f, 24.8436f, 40.8391f, 20.0313f, 23.3686f, 29.2559f, 1.15334f,
  0.985899f, 0.790834f, 3.96777f, 3.50054f, 2.19034f, -12.6518f, -10.2633f, -4.85257f, 41.9502f, 30.9296f, 13.7486f,
  7.46824f, 16.1088f, 28.0685f, 12.2135f, 13.3122f, 15.4844f, 1.25299f, 1.11578f, 0.926416f, 3.82081f, 3.13063f,
  1.71645f, -11.1534f, -7.58174f, -1.59704f, 37.2159f, 23.3653f, 4.73972f, 20.1492f, 31.7105f, 45.0768f, 21.8232f,
  24.1386f, 28.7891f, 0.974608f, 0.886499f, 0.740362f, 4.05163f, 3.17289f, 1.784f, -12.9845f, -8.68755f, -2.98385f,
  37.5496f, 23.6216f, 7.62256f, 17.4923f, 26.2185f, 35.0761f, 14.2062f, 14.7497f, 16.158f, 1.09195f, 1.01318f,
  0.859519f, 3.66303f, 2.69934f, 1.34603f, -10.3133f, -5.60271f, -0.028019f, 29.7899f, 15.0016f, -0.658291f, 32.9684f,
  42.1761f, 50.1752f, 23.7545f, 25.1596f, 28.5295f, 0.844802f, 0.794697f, 0.684011f, 3.18181f, 2.18935f, 1.15446f,
  -8.75734f, -4.20795f, -0.239383f, 21.9796f, 9.39909f, -0.789689f, 35.2403f, 40.6285f, 42.8276f, 16.3955f, 16.8175f,
  17.7947f, 0.950169f, 0.897632f, 0.775412f, 2.66458f, 1.72695f, 0.770925f, -5.54517f, -1.29612f, 2.2002f, 12.8116f,
  1.18368f, -7.48766f, 51.5477f, 55.0322f, 54.3662f, 25.7428f, 26.4307f, 28.9343f,
};
// clang-format on

}  // namespace nearlight::core
