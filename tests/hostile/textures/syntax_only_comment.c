// expect: 1:1: the file defines no function; a texture is a function that returns a colour
// nothing here
