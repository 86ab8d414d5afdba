// One level of a face's pyramid from the one below: level job.y of face job.x.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadows/izb/frame.glsl"

void main() {
    const uint face = push.job.x, level = push.job.y;
    const uint log_width = push.frame.at.faces[face].log_width;
    const uint log_height = push.frame.at.faces[face].log_height;
    const uint width = 1u << (max(log_width, level) - level);
    const uint height = 1u << (max(log_height, level) - level);
    const uint child_width = 1u << (max(log_width, level - 1) - (level - 1));
    const uint child_height = 1u << (max(log_height, level - 1) - (level - 1));
    const uint node = workgroup() * gl_SubgroupSize + lane();
    if (node >= width * height) return;
    const uint log_row = max(log_width, level) - level;
    const uint x = 2 * (node & (width - 1)), y = 2 * (node >> log_row);
    const uint right = min(x + 1, child_width - 1), below = min(y + 1, child_height - 1);
    const uint from = push.frame.at.faces[face].level_first[level - 1];
    const uint top = min(push.farthest.at[from + y * child_width + x],
                         push.farthest.at[from + y * child_width + right]);
    const uint bottom = min(push.farthest.at[from + below * child_width + x],
                            push.farthest.at[from + below * child_width + right]);
    push.farthest.at[push.frame.at.faces[face].level_first[level] + node] = min(top, bottom);
}
