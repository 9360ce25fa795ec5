// The band around a no-go area that a voyage keeps clear of.

import { Style } from "./route_layers.js";

// How wide the band is [px] where one pixel is so many metres at the equator.
export function marginPixels({ ring, properties }, resolution) {
  const corners = ring.slice(1), lat = corners.reduce((sum, [, one]) => sum + one, 0) / corners.length;
  return (1852 * (properties?.keep_clear_nm || 0)) / (resolution * Math.cos((lat * Math.PI) / 180));
}

// Its styles: none where it is too narrow to be seen. The area itself is left out of the band.
export function marginStyles(area, paint, resolution) {
  const width = marginPixels(area, resolution);
  if (width < 2) return [];
  const renderer = ([ring], { context: pen, pixelRatio }) => {
    const path = new Path2D();
    ring.forEach(([x, y], i) => (i ? path.lineTo(x, y) : path.moveTo(x, y)));
    path.closePath();
    const outside = new Path2D(path);
    outside.rect(-1e5, -1e5, 2e5, 2e5);
    pen.save();
    pen.clip(outside, "evenodd");
    Object.assign(pen, { strokeStyle: paint, globalAlpha: 0.2, lineWidth: 2 * width * pixelRatio, lineJoin: "round" });
    pen.setLineDash([]);
    pen.stroke(path);
    pen.restore();
  };
  return [new Style({ renderer })];
}
