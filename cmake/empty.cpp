// A program that does nothing: what is linked with it is what matters.
int main() {}
