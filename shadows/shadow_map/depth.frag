// Rendering a shadow map, step 3: depth is all there is.
#version 460

void main() {}
