// SPDX-License-Identifier: Apache-2.0
// render_to_png SCENE OUT.png: a picture of the scene, 256 pixels wide and high.
#include <nearlight/nearlight.h>

#include <exception>
#include <iostream>

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: render_to_png SCENE OUT.png\n";
        return 2;
    }
    try {
        nearlight::set_message_sink([](nearlight::MessageLevel level, std::string_view text) {
            if (level != nearlight::MessageLevel::debug) {
                std::cerr << text << "\n";
            }
        });
        const nearlight::Scene scene = nearlight::Scene::load(argv[1]);
        const nearlight::Devices devices = nearlight::Devices::choose("auto");
        nearlight::Session session(devices, scene);

        nearlight::RenderSettings settings;
        settings.view.width = settings.view.height = 256;
        settings.sampling.vpl_count = 500;
        const nearlight::Picture picture = session.render(settings);

        nearlight::write_image(argv[2], picture.image, {.exposure = 0.5f});
        std::cout << picture.image.width << "x" << picture.image.height << " pixels of " << scene.name()
                  << " by " << picture.vpl_count << " VPLs on " << devices.infos().front().name << "\n";
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
}
