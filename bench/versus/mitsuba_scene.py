# SPDX-License-Identifier: Apache-2.0
"""Reads scenes of Mitsuba 3 and of its predecessors for the race."""
import os
import xml.etree.ElementTree as xml


def with_box_filters(path):
    """The text of a scene's file whose films weigh samples by a box, so that pixels have noise of their own."""
    scene = xml.parse(path).getroot()
    for film in scene.iter('film'):
        for other in film.findall('rfilter'):
            film.remove(other)
        xml.SubElement(film, 'rfilter', {'type': 'box'})
    return xml.tostring(scene, encoding='unicode')


def loaded(mi, path, box_filter=False):
    """The scene of a file, by the file's filter or by a box. Properties that Mitsuba 3 no longer knows are passed over."""
    config = mi.parser.ParserConfig(mi.variant())
    config.unused_properties = mi.LogLevel.Debug
    # Mitsuba 3.9.1 merges meshes that share a BSDF when it optimizes a scene, and open rooms then get wrong light.
    config.merge_meshes = False
    config.merge_equivalent = False
    mi.file_resolver().prepend(os.path.dirname(os.path.abspath(path)))
    state = mi.parser.parse_string(config, with_box_filters(path)) if box_filter else mi.parser.parse_file(config, path)
    mi.parser.transform_all(config, state)
    scene = mi.parser.instantiate(config, state)
    return scene[0] if isinstance(scene, list) else scene
