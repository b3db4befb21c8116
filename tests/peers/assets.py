# SPDX-License-Identifier: Apache-2.0
"""The meshes and pictures that the scenes refer to, made from formulas. Runs where Mitsuba is loaded, which writes the EXRs."""
import math
import os
import struct
import zlib

import numpy as np


def write(folder):
    os.makedirs(folder, exist_ok=True)
    _write_meshes(folder)
    _write_pictures(folder)


# Meshes: positions, normals, texture coordinates and triangles of grids.

def _grid(rows, columns, point):
    """A surface over the unit square: point(u, v) gives a position and a normal."""
    uv = [(c / columns, r / rows) for r in range(rows + 1) for c in range(columns + 1)]
    positions, normals = zip(*(point(u, v) for u, v in uv))
    triangles = []
    for r in range(rows):
        for c in range(columns):
            a = r * (columns + 1) + c
            b = a + columns + 1
            triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    return np.array(positions), np.array(normals), np.array(uv), np.array(triangles)


def _ball(u, v):
    across, up = 2 * math.pi * u, math.pi * (v - 0.5)
    normal = (math.cos(up) * math.sin(across), math.sin(up), math.cos(up) * math.cos(across))
    return normal, normal


def _wave(u, v):
    """A sheet over [-1, 1]² in the plane z = 0, with hills of height 0.15."""
    a, b = 2 * math.pi * u, 2 * math.pi * v
    height = 0.15 * math.sin(a) * math.sin(b)
    slope = 0.15 * math.pi * np.array([math.cos(a) * math.sin(b), math.sin(a) * math.cos(b)])
    normal = np.array([-slope[0], -slope[1], 1.0])
    return (2 * u - 1, 2 * v - 1, height), tuple(normal / np.linalg.norm(normal))


def _write_meshes(folder):
    # The poles of a ball are moved a little, as triangles without area are another subject.
    ball = _grid(6, 10, lambda u, v: _ball(u, 0.02 + 0.96 * v))
    wave = _grid(6, 6, _wave)
    fine = _grid(16, 24, lambda u, v: _ball(u, 0.005 + 0.99 * v))
    for name, mesh in (('ball', ball), ('wave', wave), ('fine_ball', fine)):
        _write_obj(f'{folder}/{name}.obj', *mesh, with_normals=True)
        _write_obj(f'{folder}/{name}_flat.obj', *mesh, with_normals=False)
    _write_ply(f'{folder}/ball.ply', *ball, with_normals=True)
    _write_ply(f'{folder}/ball_flat.ply', *ball, with_normals=False)
    _write_ply(f'{folder}/wave_colors.ply', *wave, with_normals=True, face_colors=False)
    _write_ply(f'{folder}/wave_color_bytes.ply', *wave, with_normals=True, face_colors=False, are_bytes=True)
    _write_ply(f'{folder}/wave_face_colors.ply', *wave, with_normals=True, face_colors=True)
    _write_text(f'{folder}/curve.txt', [f'{math.cos(a) / 2:.4f} {0.3 + 0.15 * a:.4f} {math.sin(a) / 2:.4f} 0.08' for a in range(8)])
    _write_serialized(f'{folder}/meshes.serialized', [ball, wave])


def _write_obj(name, positions, normals, uv, triangles, with_normals):
    lines = [f'v {x:.6f} {y:.6f} {z:.6f}' for x, y, z in positions]
    lines += [f'vt {u:.6f} {v:.6f}' for u, v in uv]
    if with_normals:
        lines += [f'vn {x:.6f} {y:.6f} {z:.6f}' for x, y, z in normals]
    corner = (lambda i: f'{i}/{i}/{i}') if with_normals else (lambda i: f'{i}/{i}')
    lines += ['f ' + ' '.join(corner(i + 1) for i in triangle) for triangle in triangles]
    _write_text(name, lines)


def _write_ply(name, positions, normals, uv, triangles, with_normals, face_colors=None, are_bytes=False):
    """`face_colors` False adds a colour to each vertex, made of bytes if `are_bytes`, True adds one to each face."""
    columns = [positions] + ([normals] if with_normals else []) + [uv]
    properties = ['x', 'y', 'z'] + (['nx', 'ny', 'nz'] if with_normals else []) + ['u', 'v']
    if face_colors is False:
        colors = 0.5 + 0.4 * np.sin(positions * 3 + (0, 1, 2))
        columns.append(np.round(255 * colors) if are_bytes else colors)
        properties += ['red', 'green', 'blue'] if are_bytes else ['r', 'g', 'b']
    vertices = np.concatenate(columns, axis=1)
    lines = ['ply', 'format ascii 1.0', f'element vertex {len(vertices)}']
    is_byte = [p in ('red', 'green', 'blue') for p in properties]
    lines += [f'property {"uchar" if b else "float"} {p}' for p, b in zip(properties, is_byte)]
    lines += [f'element face {len(triangles)}', 'property list uchar int vertex_indices']
    if face_colors:
        lines += ['property float r', 'property float g', 'property float b']
    lines += ['end_header']
    lines += [' '.join(f'{x:.0f}' if b else f'{x:.6f}' for x, b in zip(vertex, is_byte)) for vertex in vertices]
    for number, triangle in enumerate(triangles):
        color = f' {0.2 + 0.6 * (number % 3 == 0)} {0.2 + 0.6 * (number % 4 == 1)} 0.5' if face_colors else ''
        lines.append('3 ' + ' '.join(str(i) for i in triangle) + color)
    _write_text(name, lines)


def _write_text(name, lines):
    with open(name, 'w', encoding='utf-8') as out:
        out.write('\n'.join(lines) + '\n')


def _write_serialized(name, meshes):
    """Mitsuba's own format, version 4: compressed meshes, then their offsets and their number."""
    has_normals, has_uv, double_precision = 0x0001, 0x0002, 0x2000
    data, offsets = b'', []
    for number, (positions, normals, uv, triangles) in enumerate(meshes):
        body = struct.pack('<I', has_normals | has_uv | double_precision) + f'mesh {number}\0'.encode()
        body += struct.pack('<QQ', len(positions), len(triangles))
        body += b''.join(a.astype('<f8').tobytes() for a in (positions, normals, uv)) + triangles.astype('<u4').tobytes()
        offsets.append(len(data))
        data += struct.pack('<HH', 0x041C, 4) + zlib.compress(body)
    data += struct.pack(f'<{len(offsets)}Q', *offsets) + struct.pack('<I', len(offsets))
    with open(name, 'wb') as out:
        out.write(data)


# Pictures.

def _write_pictures(folder):
    random = np.random.default_rng(1)
    _write_png(f'{folder}/tiles.png', random.uniform(0.2, 0.9, (8, 8, 3)))
    _write_png(f'{folder}/wood.png', _smooth(random.uniform(0.1, 0.9, (32, 32, 3))))
    _write_png(f'{folder}/grey.png', _smooth(random.uniform(0.0, 1.0, (16, 16, 1))))
    _write_png(f'{folder}/rough.png', 0.15 + 0.5 * _steps(16)[..., None])
    _write_png(f'{folder}/leaf.png', _disc(64, 0.42)[..., None])
    _write_png(f'{folder}/hills.png', _smooth(random.uniform(0.0, 1.0, (32, 32, 1))))
    _write_png(f'{folder}/normals.png', _normal_map(64))
    _write_png(f'{folder}/slide.png', 0.1 + 0.9 * random.uniform(0, 1, (6, 8, 3)))
    _write_exr(f'{folder}/bright.exr', 0.2 + 1.1 * random.uniform(0, 1, (8, 8, 3)) ** 2)
    _write_exr(f'{folder}/linear.exr', random.uniform(0.1, 0.9, (8, 8, 3)))
    _write_exr(f'{folder}/grey.exr', random.uniform(0.1, 0.9, (8, 8, 1)))
    _write_exr(f'{folder}/lamp.exr', random.uniform(0, 4, (8, 8, 3)) ** 2)
    _write_exr(f'{folder}/sky.exr', _sky(64, 32, 0.0))
    _write_exr(f'{folder}/sunny.exr', _sky(128, 64, 800.0))
    _write_exr(f'{folder}/odd.exr', _sky(45, 31, 30.0))


def _smooth(pixels):
    """Pixels averaged with their neighbours, going round at the edges."""
    for axis in (0, 1):
        pixels = (np.roll(pixels, 1, axis) + 2 * pixels + np.roll(pixels, -1, axis)) / 4
    low, high = pixels.min(), pixels.max()
    return (pixels - low) / (high - low) * 0.8 + 0.1


def _steps(size):
    x = np.arange(size) // 4 % 2
    return np.abs(x[:, None] - x[None, :]).astype(float)


def _disc(size, radius):
    x = (np.arange(size) + 0.5) / size - 0.5
    return (np.hypot(x[:, None], x[None, :]) < radius).astype(float)


def _normal_map(size):
    a = 2 * math.pi * (np.arange(size) + 0.5) / size * 3
    tilt = np.stack([0.4 * np.cos(a)[None, :] * np.ones((size, 1)), 0.4 * np.cos(a)[:, None] * np.ones((1, size))], axis=2)
    normal = np.concatenate([tilt, np.sqrt(1 - (tilt ** 2).sum(axis=2, keepdims=True))], axis=2)
    return 0.5 + 0.5 * normal


def _sky(width, height, sun):
    """A gradient from the zenith to the ground, a cloud of light, and a small sun of the given radiance."""
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    sky = np.stack([0.3 + 0.4 * v, 0.4 + 0.2 * v, 0.9 - 0.5 * v], axis=2)
    sky += 2.0 * np.exp(-((u - 0.35) ** 2 * 4 + (v - 0.3) ** 2) / 0.01)[..., None]
    sky += sun * (np.hypot((u - 0.6) * 2, v - 0.25) < 0.02)[..., None] * (1.0, 0.8, 0.6)
    return sky


def _write_png(name, pixels):
    """Pixels in [0, 1], one channel or three, written as they are with 8 bits."""
    height, width, channels = pixels.shape
    rows = np.clip(np.round(pixels * 255), 0, 255).astype(np.uint8).reshape(height, -1)
    raw = b''.join(b'\0' + row.tobytes() for row in rows)
    header = struct.pack('>IIBBBBB', width, height, 8, 2 if channels == 3 else 0, 0, 0, 0)
    with open(name, 'wb') as out:
        out.write(b'\x89PNG\r\n\x1a\n' + _chunk(b'IHDR', header) + _chunk(b'IDAT', zlib.compress(raw)) + _chunk(b'IEND', b''))


def _chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))


def _write_exr(name, pixels):
    import mitsuba as mi
    mi.Bitmap(np.ascontiguousarray(pixels, dtype=np.float32)).write(name)
