// SPDX-License-Identifier: Apache-2.0
// vpls_to_file SCENE OUT.csv: the virtual point lights for the scene's camera, one a line, and on standard
// output how many there are and the flux that they reflect together.
#include <nearlight/nearlight.h>

#include <exception>
#include <fstream>
#include <iostream>

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: vpls_to_file SCENE OUT.csv\n";
        return 2;
    }
    try {
        nearlight::Session session(nearlight::Devices::choose(), nearlight::Scene::load(argv[1]));
        const nearlight::View view = session.look();
        const nearlight::VplSet vpls = session.sample(view, {.vpl_count = 1000}, 7);

        std::ofstream file(argv[2]);
        file << "x,y,z,normal x,normal y,normal z,red W,green W,blue W,depth,close\n";
        nearlight::Vec3 sum{};
        for (const nearlight::VirtualPointLight& light : vpls.lights()) {
            const auto& [position, normal, power, depth, close] = light;
            file << position.x << ',' << position.y << ',' << position.z << ',' << normal.x << ',' << normal.y
                 << ',' << normal.z << ',' << power.x << ',' << power.y << ',' << power.z << ',' << depth
                 << ',' << close << '\n';
            sum = {sum.x + power.x, sum.y + power.y, sum.z + power.z};
        }
        std::cout << vpls.size() << " VPLs, " << vpls.close_count() << " of them within " << view.range()
                  << " m of the camera\n"
                  << sum.x << " " << sum.y << " " << sum.z << " W\n";
        return file.flush() ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
}
