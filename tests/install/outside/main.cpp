// SPDX-License-Identifier: Apache-2.0
// outside SCENE OUT: this file and its CMakeLists.txt are a whole project (docs/api.md).
#include <nearlight/nearlight.h>

int main(int, char** argv) {
    nearlight::Session session(nearlight::Devices::choose(), nearlight::Scene::load(argv[1]));
    const nearlight::Picture picture =
        session.render({.view = {.width = 64, .height = 64}, .sampling = {.vpl_count = 200}});
    nearlight::write_image(argv[2], picture.image);
}
