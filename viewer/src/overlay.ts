import * as THREE from 'three';
import { Label } from './label';
import type { Pose, Scene } from './scene';

const ROBOT = 0x009e73;
const TASK = 0xe69f00;
const GHOST = 0x7a4fbf;

function place(object: THREE.Object3D, pose: Pose): void {
  const [x, y, z = 0] = pose.position;
  const [w, qx, qy, qz] = pose.orientation;
  object.position.set(x, y, z);
  object.quaternion.set(qx, qy, qz, w);
}

/** Robots, where tasks want them to look, an object's past, and where else it may be. */
export class Overlay extends THREE.Group {
  private readonly robots = new Map<string, THREE.Group>();
  private readonly tasks = new THREE.Group();
  private readonly ghosts = new THREE.Group();

  constructor() {
    super();
    this.add(this.tasks, this.ghosts);
  }

  show(scene: Scene): void {
    for (const [name, group] of this.robots)
      if (!(name in scene.robots)) {
        this.remove(group);
        this.robots.delete(name);
      }
    for (const [name, pose] of Object.entries(scene.robots)) {
      let robot = this.robots.get(name);
      if (!robot) {
        robot = figure(ROBOT, name || 'robot');
        this.robots.set(name, robot);
        this.add(robot);
      }
      place(robot, pose);
    }
    this.tasks.clear();
    for (const task of Object.values(scene.tasks)) {
      const at = scene.objects[task.object]?.position;
      if (!task.viewpoint || !at) continue;
      const look = figure(TASK, '');
      place(look, task.viewpoint);
      const [x, y, z = 0] = task.viewpoint.position;
      const line = new THREE.Line(
        new THREE.BufferGeometry().setFromPoints([
          new THREE.Vector3(x, y, z + 0.3), new THREE.Vector3(at[0], at[1], at[2] ?? 0),
        ]),
        new THREE.LineDashedMaterial({ color: TASK, dashSize: 0.15, gapSize: 0.1 }),
      );
      line.computeLineDistances();
      this.tasks.add(look, line);
    }
  }

  /** Places where an object may be, with p and a word each, and a line along where it was. */
  haunt(ghosts: { position: number[]; p: number; text: string }[], past: number[][] = []): void {
    this.ghosts.clear();
    for (const { position, p, text } of ghosts) {
      const ghost = new THREE.Mesh(
        new THREE.IcosahedronGeometry(0.09),
        new THREE.MeshBasicMaterial({ color: GHOST, wireframe: true, transparent: true, opacity: 0.3 + 0.7 * p }),
      );
      const label = new Label();
      label.set(text);
      ghost.position.set(position[0], position[1], position[2] ?? 0);
      label.position.copy(ghost.position);
      this.ghosts.add(ghost, label);
    }
    if (past.length > 1)
      this.ghosts.add(
        new THREE.Line(
          new THREE.BufferGeometry().setFromPoints(past.map(([x, y, z]) => new THREE.Vector3(x, y, z ?? 0))),
          new THREE.LineBasicMaterial({ color: GHOST }),
        ),
      );
  }
}

/** A cone that points along +x, as a robot's base looks. */
function figure(color: number, name: string): THREE.Group {
  const cone = new THREE.Mesh(
    new THREE.ConeGeometry(0.18, 0.5, 20),
    new THREE.MeshStandardMaterial({ color }),
  );
  cone.rotation.z = -Math.PI / 2;
  cone.position.z = 0.15;
  const group = new THREE.Group();
  group.add(cone);
  if (name) {
    const label = new Label();
    label.set(name);
    label.position.z = 0.35;
    group.add(label);
  }
  return group;
}
