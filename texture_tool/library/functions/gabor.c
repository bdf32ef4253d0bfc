// Gabor noise in the plane (Lagae et al., "Procedural Noise using Sparse Gabor Convolution", 2009):
// waves under Gaussian bells at random points, so that the spectrum is a bell around a frequency
// and a direction. Cells are as wide as a kernel reaches, so that nine of them hold all that count.
// A cell has a Poisson number of impulses of mean 3, cut off at 8 (which 0.4 % would exceed), a
// density of 3 pi = 9.4 impulses under each kernel.

// How many of 8 impulses a cell has: the inverse of Poisson's distribution of mean 3.
int gabor_impulses(float u)
{
    int count = u < 0.0497870684f ? 0 : 1;
    count += u < 0.199148273f ? 0 : 1;
    count += u < 0.423190081f ? 0 : 1;
    count += u < 0.647231889f ? 0 : 1;
    count += u < 0.815263245f ? 0 : 1;
    count += u < 0.916082058f ? 0 : 1;
    count += u < 0.966491465f ? 0 : 1;
    count += u < 0.988095496f ? 0 : 1;
    return count;
}

// One wave at distance (x, y) from its impulse, in units of the kernel's reach, where the bell has
// fallen to 1/20; it is made to end there. `turn` in revolutions.
float gabor_kernel(float x, float y, float frequency, float turn)
{
    const float r = x * x + y * y;
    const float bell = (exp(-2.99573227f * r) - 0.05f) * 1.05263158f;
    const float wave = cospi(2.0f * frequency * (x * cospi(2.0f * turn) + y * sinpi(2.0f * turn)));
    return r < 1.0f ? bell * wave : 0.0f;
}

// Of mean 0 and standard deviation one third: with impulses of density 3 and random signs, the
// variance is 3 times the integral of the squared kernel, 0.239 (1 + e^(-6.59 frequency^2)).
// `p` in kernel reaches; `frequency` in waves for each, from 0 to 8; `turn` is the direction of the
// waves in revolutions, and `spread`, from 0 to 1, how much of the half circle about it they take
// (0: all waves parallel; 1: all directions alike).
float gabor2_seeded(float2 p, float frequency, float turn, float spread, uint seed)
{
    const float x0 = floor(p.x) - 1.0f;
    const float y0 = floor(p.y) - 1.0f;
    const uint corner = lattice_sum2((int)x0, (int)y0);
    const uint s = hash_scramble(seed);
    float sum = 0.0f;
    for (int i = 0; i < 72; ++i) {
        const int cell = i >> 3;
        const int row = (cell * 11) >> 5;
        const int column = cell - 3 * row;
        const uint own = hash_scramble((corner + lattice_sum2(column, row)) ^ s);
        const uint place = hash_scramble(own + (uint)(i & 7) * 0x9e3779b9u + 1u);
        const uint kind = hash_scramble(place);
        const float2 at = hash_fractions2(place);
        const float x = p.x - x0 - (float)column - at.x;
        const float y = p.y - y0 - (float)row - at.y;
        const float own_turn = turn + 0.5f * spread * (hash_fraction(kind) - 0.5f);
        const float value = gabor_kernel(x, y, frequency, own_turn);
        const float signed_value = (kind & 1u) != 0u ? value : -value;
        sum += (i & 7) < gabor_impulses(hash_fraction(own)) ? signed_value : 0.0f;
    }
    return sum * 0.393f / sqrt(1.0f + exp(-6.59f * frequency * frequency));
}

float gabor2(float2 p, float frequency, float turn, float spread)
{
    return gabor2_seeded(p, frequency, turn, spread, 0u);
}
