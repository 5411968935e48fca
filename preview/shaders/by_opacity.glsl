// Light ends at the first surface that it meets.
const bool by_count = false;
