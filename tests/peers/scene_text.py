# SPDX-License-Identifier: Apache-2.0
"""Mitsuba scenes as short Python expressions, and the stages on which most rows play.

`bsdf('plastic', int_ior=1.5, diffuse_reflectance=rgb(0.5))` stands for the XML element of that type, with one child for
each argument: Python's type decides the child's, and the argument's name is its name.
"""
from dataclasses import dataclass

ASSETS = '../assets/'


@dataclass(frozen=True)
class Element:
    """A piece of XML. `NAME` in its text marks the place of a name attribute."""
    text: str

    def named(self, name):
        return self.text.replace('NAME', f' name="{name}"', 1)

    def plain(self):
        return self.text.replace('NAME', '', 1)


def element(tag, kind, *children, **properties):
    inner = [child.plain() for child in children] + [_property(name, value) for name, value in properties.items()]
    return Element(f'<{tag} type="{kind}"NAME>\n' + _indented('\n'.join(inner)) + f'\n</{tag}>')


def _property(name, value):
    if isinstance(value, Element):
        return value.named(name)
    kind = {bool: 'boolean', int: 'integer', float: 'float', str: 'string'}[type(value)]
    shown = str(value).lower() if kind == 'boolean' else value
    return f'<{kind} name="{name}" value="{shown}"/>'


def _indented(text):
    return '\n'.join('  ' + line for line in text.split('\n') if line)


def _element_of(tag):
    return lambda kind, *children, **properties: element(tag, kind, *children, **properties)


bsdf, emitter, shape, texture, sensor, film, integrator, rfilter, spectrum_plugin = (
    _element_of(tag) for tag in ('bsdf', 'emitter', 'shape', 'texture', 'sensor', 'film', 'integrator', 'rfilter', 'spectrum'))


def rgb(*values):
    return Element(f'<rgbNAME value="{", ".join(str(v) for v in values)}"/>')


def spectrum(value):
    """The element <spectrum>: one number, or "wavelength:value" pairs."""
    return Element(f'<spectrumNAME value="{value}"/>')


def point(x, y, z):
    return Element(f'<pointNAME x="{x}" y="{y}" z="{z}"/>')


def vector(x, y, z):
    return Element(f'<vectorNAME x="{x}" y="{y}" z="{z}"/>')


def ref(name):
    return Element(f'<refNAME id="{name}"/>')


def with_id(name, what):
    return Element(what.text.replace('NAME', f' id="{name}"NAME', 1))


def transform(*steps):
    return Element('<transformNAME>\n' + _indented('\n'.join(steps)) + '\n</transform>')


def move(x, y, z):
    return f'<translate x="{x}" y="{y}" z="{z}"/>'


def scale(x, y=None, z=None):
    return f'<scale value="{x}"/>' if y is None else f'<scale x="{x}" y="{y}" z="{z}"/>'


def turn(axis, degrees):
    return f'<rotate {axis}="1" angle="{degrees}"/>'


def look(origin, target, up='0, 1, 0'):
    return f'<lookat origin="{origin}" target="{target}" up="{up}"/>'


def place(size, at, *turns):
    """The to_world of something that is scaled, turned and then moved."""
    return transform(scale(*size) if isinstance(size, tuple) else scale(size), *turns, move(*at))


def bitmap(name, **properties):
    return texture('bitmap', filename=ASSETS + name, **properties)


def mesh(name, *children, **properties):
    return shape(name.rsplit('.', 1)[1], *children, filename=ASSETS + name, **properties)


def scene(*parts, depth=5, camera=None, path=None, version='3.0.0'):
    path = path or integrator('path', max_depth=depth)
    inner = '\n'.join(p.plain() for p in (path, camera or perspective(), *parts))
    return f'<scene version="{version}">\n{_indented(inner)}\n</scene>\n'


# The sensor and the stages that rows use unless they are about others.

def picture(*children, width=64, height=48, **properties):
    return film('hdrfilm', *(children or (rfilter('box'),)), width=width, height=height, **properties)


VIEW = look('0, 1.2, 4.2', '0, 0.7, 0')


def perspective(*children, to_world=VIEW, the_film=None, **properties):
    properties.setdefault('fov', 42.0)
    return sensor('perspective', the_film or picture(), *children, to_world=transform(to_world), **properties)


def diffuse(*color):
    return bsdf('diffuse', reflectance=rgb(*(color or (0.5,))))


def rectangle(*children, at=(0, 0, 0), size=1, turned=None, **properties):
    """A rectangle with sides of 2·size that faces +z before `turned` turns it."""
    steps = [scale(size)] + list(turned or []) + [move(*at)]
    return shape('rectangle', *children, to_world=transform(*steps), **properties)


UP, DOWN = [turn('x', -90)], [turn('x', 90)]


def floor(material=None, size=4):
    return rectangle(material or diffuse(0.5, 0.45, 0.4), size=size, turned=UP)


def wall(material=None):
    return rectangle(material or diffuse(0.4, 0.45, 0.5), at=(0, 0, -1.5), size=4)


def sphere(*children, at=(0, 0.7, 0), radius=0.7, **properties):
    return shape('sphere', *children, center=point(*at), radius=float(radius), **properties)


def box(*children, at=(0, 0.5, 0), size=0.5, degrees=30, **properties):
    return shape('cube', *children, to_world=transform(scale(size), turn('y', degrees), move(*at)), **properties)


def stage(*things):
    """A floor, a wall and a diffuse box."""
    return (floor(), wall(), *(things or (box(diffuse(0.6, 0.3, 0.2)),)))


SIDES = {'back': ((0, 0, -3), []), 'front': ((0, 0, 3), [turn('y', 180)]), 'left': ((-2, 1.5, 0), [turn('y', 90)]),
         'right': ((2, 1.5, 0), [turn('y', -90)]), 'ground': ((0, 0, 0), UP), 'ceiling': ((0, 3, 0), DOWN)}


def room(material, *things, **others):
    """A room 4 wide, 3 high and 6 deep. Its sides are of one material, except `others`, of which None is left open."""
    sides = {side: others.get(side, material) for side in SIDES}
    walls = [rectangle(m, at=SIDES[side][0], turned=SIDES[side][1], size=4) for side, m in sides.items() if m]
    return (*walls, *things)


INSIDE = look('0, 1.5, 2.8', '0, 1.2, 0')   # the view of a room from its front side


def point_light(intensity=12.0, at=(1.5, 2.5, 2)):
    return emitter('point', position=point(*at), intensity=rgb(intensity))


def area(radiance=10.0):
    return emitter('area', radiance=rgb(radiance))


def lamp(radiance=10.0, size=0.5, at=(0.8, 2.6, 1.0)):
    """A rectangle above the stage that shines down, out of the picture."""
    return rectangle(area(radiance), diffuse(0), at=at, size=size, turned=DOWN)


def constant(radiance=1.0):
    return emitter('constant', radiance=rgb(radiance))


def envmap(name='sky.exr', *children, **properties):
    return emitter('envmap', *children, filename=ASSETS + name, **properties)
