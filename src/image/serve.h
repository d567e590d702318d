/* The image decoder's side of protocol.h. */
#ifndef HOODOO_IMAGE_SERVE_H
#define HOODOO_IMAGE_SERVE_H

/* The main() of hoodoo-read-image. */
int image_serve_main(int argc, char **argv);

#endif
