// SPDX-License-Identifier: Apache-2.0
#include "host/cli/tunables_output.h"
#include "host/base/words.h"

namespace nearlight::core {

nlohmann::ordered_json to_json(const Tunables& tunables) {
    nlohmann::ordered_json json;
    for (const TunableField& field : tunable_fields()) {
        json[field.name] = tunables.*field.value;
    }
    return json;
}

nlohmann::ordered_json to_json(const ChosenTunables& chosen) {
    nlohmann::ordered_json json{{"source", chosen.source}, {"is_tuned", chosen.is_tuned}};
    json.update(to_json(chosen.values));
    return json;
}

std::string to_text(const Tunables& tunables) {
    return joined(tunable_fields(), ", ", [&](const TunableField& field) {
        return std::string(field.name) + " " + std::to_string(tunables.*field.value);
    });
}

}  // namespace nearlight::core
