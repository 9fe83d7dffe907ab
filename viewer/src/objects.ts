import * as THREE from 'three';
import { shade } from './colors';
import { ellipsoid, symmetric } from './ellipsoid';
import { Label } from './label';
import type { Anchor } from './scene';

const SMALLEST = 0.12; // m, of a class without an extent
const SHARE = 0.008; // of the world's size: what is smaller is not seen in a wide one
const SIGMAS = 2;
const WIDEST = 3; // m: a wider ellipsoid says nothing more
const TRAIL = 200; // positions
const BOX = new THREE.BoxGeometry(1, 1, 1);
const SPHERE = new THREE.SphereGeometry(1, 20, 14);

/** One anchor: its shape, name, uncertainty, and where it was. */
class Figure extends THREE.Group {
  readonly shape: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  private readonly cloud: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private readonly label = new Label();
  private readonly trail = new THREE.Line(
    new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ transparent: true, opacity: 0.6 }),
  );
  private readonly path: THREE.Vector3[] = [];

  constructor(private readonly anchor: string, private readonly size: number) {
    super();
    this.shape = new THREE.Mesh(BOX, new THREE.MeshStandardMaterial({ transparent: true }));
    this.shape.userData.id = anchor;
    this.cloud = new THREE.Mesh(
      SPHERE,
      new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.16, depthWrite: false }),
    );
    this.cloud.matrixAutoUpdate = false;
    this.add(this.shape, this.cloud, this.label, this.trail);
  }

  show(anchor: Anchor, chosen: boolean): void {
    const [x, y, z = 0] = anchor.position;
    const at = new THREE.Vector3(x, y, z);
    const extent = anchor.extent ?? [this.size, this.size, this.size];
    const color = shade(anchor.class, anchor.attributes);
    const lost = (anchor.somewhere ?? 0) >= 0.5;
    this.shape.geometry = anchor.extent ? BOX : SPHERE;
    this.shape.scale.set(extent[0], extent[1], extent[2]);
    if (!anchor.extent) this.shape.scale.multiplyScalar(0.5);
    this.shape.position.copy(at);
    this.shape.rotation.z = anchor.yaw ?? 0;
    this.shape.material.color.set(color);
    this.shape.material.opacity = lost ? 0.15 : 0.35 + 0.65 * anchor.p;
    this.shape.material.emissive.set(chosen ? color : 0x000000);
    this.shape.material.emissiveIntensity = 0.6;
    const spread = symmetric(anchor.covariance);
    this.cloud.visible = !lost && Math.sqrt(Math.max(spread[0][0], spread[1][1])) < WIDEST;
    this.cloud.matrix.copy(ellipsoid(spread, SIGMAS, at));
    this.cloud.material.color.set(color);
    this.label.position.set(x, y, z + extent[2] / 2);
    const name = anchor.alias ?? this.anchor;
    this.label.set(anchor.p >= 0.995 ? name : `${name} ${anchor.p.toFixed(2)}`);
    this.label.visible = !lost || chosen;
    if (!lost) this.follow(at);
    this.trail.material.color.set(color);
  }

  private follow(at: THREE.Vector3): void {
    if (this.path.length && this.path[this.path.length - 1].distanceTo(at) < 0.03) return;
    this.path.push(at);
    if (this.path.length > TRAIL) this.path.shift();
    this.trail.geometry.dispose();
    this.trail.geometry = new THREE.BufferGeometry().setFromPoints(this.path);
  }

  dispose(): void {
    this.label.dispose();
    this.trail.geometry.dispose();
    this.shape.material.dispose();
    this.cloud.material.dispose();
  }
}

/** All anchors of a scene. */
export class Objects extends THREE.Group {
  private readonly figures = new Map<string, Figure>();
  private readonly size: number;

  /** In a world of so many m across. */
  constructor(across: number) {
    super();
    this.size = Math.max(SMALLEST, SHARE * across);
  }

  show(anchors: Record<string, Anchor>, chosen: string | null): void {
    for (const [id, figure] of this.figures)
      if (!(id in anchors)) {
        figure.dispose();
        this.remove(figure);
        this.figures.delete(id);
      }
    for (const [id, anchor] of Object.entries(anchors)) {
      let figure = this.figures.get(id);
      if (!figure) {
        figure = new Figure(id, this.size);
        this.figures.set(id, figure);
        this.add(figure);
      }
      figure.show(anchor, id === chosen);
    }
  }

  /** What can be picked; each has its id in userData. */
  get shapes(): THREE.Object3D[] {
    return [...this.figures.values()].map((figure) => figure.shape);
  }
}
