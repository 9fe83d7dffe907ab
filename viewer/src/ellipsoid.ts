import { Matrix3, Matrix4, Vector3 } from 'three';

/** Symmetric 3 x 3 from the upper triangle, row by row; of a 2-D world with a little height. */
export function symmetric(triangle: number[]): number[][] {
  if (triangle.length === 3) {
    const [xx, xy, yy] = triangle;
    return [[xx, xy, 0], [xy, yy, 0], [0, 0, 1e-4]];
  }
  const [xx, xy, xz, yy, yz, zz] = triangle;
  return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
}

/**
 * What turns the unit sphere into the ellipsoid of so many standard deviations: L of C = L L'.
 * Rounded covariances may be a little indefinite: pivots are kept above zero.
 */
export function ellipsoid(covariance: number[][], sigmas: number, at: Vector3): Matrix4 {
  const l = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (let i = 0; i < 3; ++i)
    for (let j = 0; j <= i; ++j) {
      let sum = covariance[i][j];
      for (let k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i === j ? Math.sqrt(Math.max(sum, 1e-8)) : sum / l[j][j];
    }
  const m = new Matrix3(
    l[0][0], 0, 0,
    l[1][0], l[1][1], 0,
    l[2][0], l[2][1], l[2][2],
  ).multiplyScalar(sigmas);
  const matrix = new Matrix4().setFromMatrix3(m);
  return matrix.setPosition(at);
}
