// A grid of cells through the object, each of its own grey: what the hash of the lattice gives.
// Result: a value in [0, 1), the same bits on every device.
//
// scale (float, 1/m, above 0; default 8): cells for each metre of the object
// seed (uint; default 0): another number gives another pattern

float cells(float scale, uint seed)
{
    const float3 place = readAttr("LocalPos");
    const float3 cell = floor(place * scale);
    return hash_fraction(hash3((int)cell.x, (int)cell.y, (int)cell.z, seed));
}
