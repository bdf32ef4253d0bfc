/* TX-15: somebody's own program, in C or C++, with an unmodified texture in it. */
#include <stdio.h>

#include "texture_tool/diptych_texture.h"

#include TEXTURE

void diptych_attribute(const char* name, float value[4])
{
    for (int i = 0; i < 4; ++i) value[i] = 0.25f * (float)(i + 1) + (float)strlen(name);
}
void diptych_image(sam2D image, float u, float v, unsigned flags, float value[4])
{
    for (int i = 0; i < 4; ++i) value[i] = u + v * (float)i + (float)image.slot + (float)flags;
}
float diptych_setting(const char* name) { return (float)strlen(name); }
float diptych_occlusion(const char* where, float distance) { return distance + (float)strlen(where); }

int main(void)
{
    sam2D image = {3, 0};
    float4 color = userProc(image, ARGUMENT);
    printf("%.4f %.4f %.4f %.4f\n", (double)color[0], (double)color[1], (double)color[2], (double)color[3]);
    return 0;
}
